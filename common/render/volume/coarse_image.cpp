#include "common/render/volume/coarse_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "common/base/check.h"
#include "common/base/parallel.h"

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
  found.nearest = static_cast<std::size_t>(std::clamp(static_cast<int>(std::lround(at)), 0, points - 1));
  const int first = std::max(0, static_cast<int>(std::floor(at - s)) + 1);
  const int last = std::min(points - 1, static_cast<int>(std::ceil(at + s)) - 1);
  for (int i = first; i <= last && found.count < found.points.size(); ++i) {
    found.points[found.count] = static_cast<std::size_t>(i);
    found.weights[found.count++] = static_cast<float>(1.0 - std::abs(i - at) / s);
  }
  return found;
}

// Numbers of points, x fastest.
struct Numbers {
  std::array<std::size_t, 3> points{};
  std::vector<float> values;
};

// Halves one axis. Strides are those of its points.
Numbers halved(const Numbers& fine, std::size_t axis) {
  const int n = static_cast<int>(fine.points[axis]);
  if (coarse_points(n) == n) return fine;
  Numbers coarse;
  coarse.points = fine.points;
  coarse.points[axis] = static_cast<std::size_t>(coarse_points(n));
  coarse.values.resize(coarse.points[0] * coarse.points[1] * coarse.points[2]);
  std::size_t stride = 1;
  for (std::size_t a = 0; a < axis; ++a) stride *= fine.points[a];
  const std::size_t layers = fine.values.size() / (stride * fine.points[axis]);
  std::vector<Neighbours> neighbours;
  for (int k = 0; k < coarse_points(n); ++k) neighbours.push_back(neighbours_of(k, n));

  const auto make_row = [&](std::size_t row) {
    const std::size_t layer = row / neighbours.size();
    const Neighbours& from = neighbours[row % neighbours.size()];
    const float* in = fine.values.data() + layer * stride * fine.points[axis];
    float* out = coarse.values.data() + row * stride;
    for (std::size_t i = 0; i < stride; ++i) {
      float sum = 0.0F, weight = 0.0F;
      for (std::size_t k = 0; k < from.count; ++k) {
        const float v = in[from.points[k] * stride + i];
        if (!std::isfinite(v)) continue;
        sum += from.weights[k] * v;
        weight += from.weights[k];
      }
      const bool blank = !std::isfinite(in[from.nearest * stride + i]);
      out[i] = blank ? std::numeric_limits<float>::quiet_NaN() : sum / weight;
    }
  };
  parallel_for(layers * neighbours.size(), 0, [&](std::size_t first, std::size_t last) {
    for (std::size_t row = first; row < last; ++row) make_row(row);
  });
  return coarse;
}

template <typename T>
void own_rounded(VolumeImage& image, const std::vector<float>& values) {
  auto numbers = std::make_shared<std::vector<T>>(values.size());
  std::transform(values.begin(), values.end(), numbers->begin(),
                 [](float v) { return static_cast<T>(std::lround(v)); });
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

}  // namespace

std::shared_ptr<const VolumeImage> coarse_image(const VolumeImage& image, int level) {
  PALPATE_CHECK(level > 0);
  auto coarse = std::make_shared<VolumeImage>(image);
  coarse->colors.reset();
  Numbers numbers;
  numbers.points = {static_cast<std::size_t>(image.points.x), static_cast<std::size_t>(image.points.y),
                    static_cast<std::size_t>(image.points.z)};
  numbers.values.resize(image.point_count());
  for (std::size_t i = 0; i < numbers.values.size(); ++i)
    numbers.values[i] = static_cast<float>(image.number(i));
  for (int k = 0; k < level; ++k) {
    for (int a = 0; a < 3; ++a) {
      coarse->axes[a] *= spacing_ratio(static_cast<int>(numbers.points[static_cast<std::size_t>(a)]));
      numbers = halved(numbers, static_cast<std::size_t>(a));
    }
  }
  coarse->points = {static_cast<int>(numbers.points[0]), static_cast<int>(numbers.points[1]),
                    static_cast<int>(numbers.points[2])};
  own_numbers(*coarse, std::move(numbers.values));
  return coarse;
}

}  // namespace palpate
