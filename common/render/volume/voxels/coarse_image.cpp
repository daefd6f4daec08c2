#include "common/render/volume/voxels/coarse_image.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/field/grid/sparse/sparse_builder.h"
#include "common/render/volume/voxels/sign_bit.h"

namespace palpate {
namespace {

int coarse_points(int points) { return points > 2 ? points / 2 + 1 : points; }

double spacing_ratio(int points) { return points > 2 ? (points - 1.0) / (coarse_points(points) - 1.0) : 1.0; }

// The fine points that a coarse one is the mean of. Less than s <= 2 points away there are four at most.
struct Neighbours {
  std::array<std::size_t, 4> points{};
  std::array<float, 4> weights{};
  std::size_t count = 0;
  std::size_t nearest = 0;
};

Neighbours neighbours_of(int coarse_point, int points) {
  const double s = spacing_ratio(points), at = s * coarse_point;
  Neighbours found;
  found.nearest = as_size(std::clamp(static_cast<int>(std::lround(at)), 0, points - 1));
  const int first = std::max(0, static_cast<int>(std::floor(at - s)) + 1);
  const int last = std::min(points - 1, static_cast<int>(std::ceil(at + s)) - 1);
  for (int i = first; i <= last && found.count < found.points.size(); ++i) {
    found.points[found.count] = as_size(i);
    found.weights[found.count++] = static_cast<float>(1.0 - std::abs(i - at) / s);
  }
  return found;
}

// Numbers of points, x fastest.
struct Numbers {
  std::array<std::size_t, 3> points{};
  std::vector<float> values;
};

// Makes the points of one axis that have these neighbours, the first of which is point `offset`. Strides are
// those of its points.
Numbers halved(const Numbers& fine, std::size_t axis, const std::vector<Neighbours>& neighbours,
               std::size_t offset, int threads) {
  Numbers coarse;
  coarse.points = fine.points;
  coarse.points[axis] = neighbours.size();
  coarse.values.resize(coarse.points[0] * coarse.points[1] * coarse.points[2]);
  std::size_t stride = 1;
  for (std::size_t a = 0; a < axis; ++a) stride *= fine.points[a];
  const std::size_t layers = fine.values.size() / (stride * fine.points[axis]);

  const auto make_row = [&](std::size_t row) {
    const std::size_t layer = row / neighbours.size();
    const Neighbours& from = neighbours[row % neighbours.size()];
    const float* in = fine.values.data() + layer * stride * fine.points[axis];
    float* out = coarse.values.data() + row * stride;
    for (std::size_t i = 0; i < stride; ++i) {
      float sum = 0.0F, weight = 0.0F;
      for (std::size_t k = 0; k < from.count; ++k) {
        const float v = in[(from.points[k] - offset) * stride + i];
        if (!std::isfinite(v)) continue;
        sum += from.weights[k] * v;
        weight += from.weights[k];
      }
      const bool blank = !std::isfinite(in[(from.nearest - offset) * stride + i]);
      out[i] = blank ? std::numeric_limits<float>::quiet_NaN() : sum / weight;
    }
  };
  parallel_for(layers * neighbours.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t row = first; row < last; ++row) make_row(row);
  });
  return coarse;
}

std::vector<Neighbours> neighbours_of_all(int points, int first, int end) {
  std::vector<Neighbours> neighbours;
  for (int k = first; k < end; ++k) neighbours.push_back(neighbours_of(k, points));
  return neighbours;
}

// Halves all axes. Some layers at a time, so that the fine numbers are not all there in single precision at once.
Numbers halved_once(const VolumeImage& image) {
  constexpr int kLayers = 4;
  Numbers coarse;
  for (int a = 0; a < 3; ++a) coarse.points[as_size(a)] = as_size(coarse_points(image.points[a]));
  const std::size_t layer = coarse.points[0] * coarse.points[1], layers = coarse.points[2];
  coarse.values.resize(layer * layers);
  parallel_for((layers + kLayers - 1) / kLayers, 0, [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = begin; part < end; ++part) {
      const int first = static_cast<int>(part) * kLayers,
                last = std::min(static_cast<int>(layers), first + kLayers);
      std::array<std::vector<Neighbours>, 3> neighbours;
      PointBox window{Index3(0), image.points};
      for (int a = 0; a < 3; ++a) {
        const bool along = a == 2;
        neighbours[as_size(a)] = neighbours_of_all(image.points[a], along ? first : 0,
                                                   along ? last : coarse_points(image.points[a]));
      }
      const auto& through = neighbours[2];
      window.first.z = static_cast<int>(through.front().points.front());
      window.end.z = static_cast<int>(through.back().points[through.back().count - 1]) + 1;
      Numbers numbers;
      numbers.points = {as_size(image.points.x), as_size(image.points.y),
                        as_size(window.end.z - window.first.z)};
      numbers.values.resize(window.count());
      const std::size_t before = as_size(window.first.z) * numbers.points[0] * numbers.points[1];
      for (std::size_t i = 0; i < numbers.values.size(); ++i)
        numbers.values[i] = static_cast<float>(image.number(before + i));
      for (std::size_t a = 0; a < 3; ++a) {
        const int n = image.points[static_cast<int>(a)];
        if (coarse_points(n) == n) continue;
        numbers = halved(numbers, a, neighbours[a], a == 2 ? as_size(window.first.z) : 0, 1);
      }
      std::ranges::copy(numbers.values,
                        coarse.values.begin() + static_cast<std::ptrdiff_t>(as_size(first) * layer));
    }
  });
  return coarse;
}

// The number that all blocks have in which points of `box` lie.
std::optional<float> only_number(const SparseNumbers& fine, const PointBox& box) {
  const Index3 first = (box.first + fine.shift()) / kBlockSide,
               last = (box.end - 1 + fine.shift()) / kBlockSide;
  const SparseBlock one = fine.block(first);
  for (int z = first.z; z <= last.z; ++z) {
    for (int y = first.y; y <= last.y; ++y) {
      for (int x = first.x; x <= last.x; ++x) {
        const SparseBlock block = fine.block({x, y, z});
        const bool same =
            std::bit_cast<std::uint32_t>(block.constant) == std::bit_cast<std::uint32_t>(one.constant);
        if (block.numbers != nullptr || !same) return std::nullopt;
      }
    }
  }
  return one.constant;
}

// What a block of coarse numbers holds.
struct CoarseBlock {
  std::optional<float> one;
  std::array<float, kBlockVoxels> numbers{};
};

void make_coarse_block(const SparseNumbers& fine, const PointBox& points, CoarseBlock& block) {
  std::array<std::vector<Neighbours>, 3> neighbours;
  PointBox window;
  for (int a = 0; a < 3; ++a) {
    auto& along = neighbours[as_size(a)];
    along = neighbours_of_all(fine.points()[a], points.first[a], points.end[a]);
    window.first[a] = static_cast<int>(along.front().points.front());
    window.end[a] = static_cast<int>(along.back().points[along.back().count - 1]) + 1;
  }
  block.one = only_number(fine, window);
  if (block.one) return;
  Numbers numbers;
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    numbers.points[a] = as_size(window.end[axis] - window.first[axis]);
  }
  numbers.values.resize(window.count());
  fine.copy(window, numbers.values.data());
  for (std::size_t a = 0; a < 3; ++a)
    numbers = halved(numbers, a, neighbours[a], as_size(window.first[static_cast<int>(a)]), 1);
  block.numbers.fill(numbers.values.front());  // beyond the volume
  std::size_t i = 0;
  for (int z = points.first.z; z < points.end.z; ++z) {
    for (int y = points.first.y; y < points.end.y; ++y) {
      for (int x = points.first.x; x < points.end.x; ++x)
        block.numbers[block_offset({x, y, z})] = numbers.values[i++];
    }
  }
}

// Halves all axes; where a neighbourhood has one number nothing is computed.
std::shared_ptr<const SparseNumbers> halved(const SparseNumbers& fine) {
  Index3 points;
  for (int a = 0; a < 3; ++a) points[a] = coarse_points(fine.points()[a]);
  SparseBuilder builder(Index3(0), points, fine.background());
  const Index3 n = builder.blocks();
  const auto row = as_size(n.x);
  std::vector<CoarseBlock> layer(row * as_size(n.y));
  const auto box_of = [&](std::size_t i, int z) {
    const Index3 b(static_cast<int>(i % row), static_cast<int>(i / row), z);
    return PointBox{kBlockSide * b, glm::min(kBlockSide * (b + 1), points)};
  };
  for (int z = 0; z < n.z; ++z) {
    parallel_for(layer.size(), 0, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) make_coarse_block(fine, box_of(i, z), layer[i]);
    });
    for (std::size_t i = 0; i < layer.size(); ++i) {
      const Index3 b = box_of(i, z).first / kBlockSide;
      if (layer[i].one) {
        builder.put(b, *layer[i].one);
      } else {
        builder.put(b, layer[i].numbers);
      }
    }
  }
  return builder.finish();
}

template <typename T>
void own_rounded(VolumeImage& image, const std::vector<float>& values) {
  auto numbers = std::make_shared<std::vector<T>>(values.size());
  std::transform(values.begin(), values.end(), numbers->begin(),
                 [sign = sign_bit<T>(image)](float v) { return static_cast<T>(std::lround(v) ^ sign); });
  image.bytes = std::as_bytes(std::span<const T>(*numbers));
  image.owner = std::move(numbers);
}

void own_numbers(VolumeImage& image, std::vector<float> values) {
  if (image.type == ScalarType::kUint8) return own_rounded<std::uint8_t>(image, values);
  if (image.type == ScalarType::kUint16) return own_rounded<std::uint16_t>(image, values);
  auto numbers = std::make_shared<const std::vector<float>>(std::move(values));
  image.bytes = std::as_bytes(std::span<const float>(*numbers));
  image.owner = std::move(numbers);
}

// Lines of the coarse points, which lie evenly in g between the same ends.
std::shared_ptr<const LatticeLines> coarse_lines(const VolumeImage& fine, const Index3& points) {
  if (!fine.lines) return nullptr;
  auto lines = std::make_shared<LatticeLines>();
  for (int a = 0; a < 3; ++a) {
    if (fine.lines->at[as_size(a)].empty()) continue;
    const double ratio = (fine.points[a] - 1.0) / std::max(1, points[a] - 1);
    for (int i = 0; i < points[a]; ++i)
      lines->at[as_size(a)].push_back(fine.mean_of_grid(Vec3(i * ratio))[a] / ratio);
  }
  return lines;
}

}  // namespace

std::shared_ptr<const VolumeImage> coarse_image(const VolumeImage& image, int level) {
  PALPATE_CHECK(level > 0);
  auto coarse = std::make_shared<VolumeImage>(image);
  coarse->colors.reset();
  if (image.sparse) {
    for (int k = 0; k < level; ++k) {
      for (int a = 0; a < 3; ++a) coarse->axes[a] *= spacing_ratio(coarse->points[a]);
      coarse->sparse = halved(*coarse->sparse);
      coarse->points = coarse->sparse->points();
    }
    coarse->lines = coarse_lines(image, coarse->points);
    return coarse;
  }
  Numbers numbers = halved_once(image);
  for (int a = 0; a < 3; ++a) coarse->axes[a] *= spacing_ratio(image.points[a]);
  for (int k = 1; k < level; ++k) {
    for (int a = 0; a < 3; ++a) {
      const auto axis = as_size(a);
      const int n = static_cast<int>(numbers.points[axis]);
      if (coarse_points(n) == n) continue;
      coarse->axes[a] *= spacing_ratio(n);
      numbers = halved(numbers, axis, neighbours_of_all(n, 0, coarse_points(n)), 0, 0);
    }
  }
  coarse->points = {static_cast<int>(numbers.points[0]), static_cast<int>(numbers.points[1]),
                    static_cast<int>(numbers.points[2])};
  coarse->lines = coarse_lines(image, coarse->points);
  own_numbers(*coarse, std::move(numbers.values));
  return coarse;
}

}  // namespace palpate
