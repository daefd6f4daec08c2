#include "common/render/volume/voxels/value_gradient.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/field/grid/sparse/sparse_numbers.h"
#include "common/math/lattice.h"
#include "common/math/power_of_two.h"
#include "common/render/volume/voxels/brick_map.h"

namespace palpate {
namespace {

constexpr std::size_t kMostMeasured = std::size_t{1} << 26U;  // points

// Gradients of an image at its points, in numbers of the image a data unit.
class PointGradients {
 public:
  explicit PointGradients(const VolumeImage& image) : image_(image) {
    // Powers of two keep tiny spacings from vanishing.
    const double unit = power_of_two(binary_exponent(image.bounds().diagonal()));
    to_data_ = glm::transpose(glm::inverse(image.axes / unit)) / unit;
    for (int a = 0; image.lines && a < 3; ++a) {
      std::vector<double>& per_step = per_step_[as_size(a)];
      for (int i = 0; i < image.points[a]; ++i) {
        const Vec3 before(i - 1), after(i + 1);
        per_step.push_back(1.0 / (image.mean_of_grid(after)[a] - image.mean_of_grid(before)[a]));
      }
    }
  }

  // (1) at x, y, z. NaN where a value lacks.
  [[nodiscard]] Vec3 at(int x, int y, int z) const {
    return at({x, y, z}, [&](const Index3& p) { return image_.number(index_in(image_.points, p)); });
  }
  // The same of the numbers that read(p) tells.
  template <typename Read>
  [[nodiscard]] Vec3 at(const Index3& place, Read read) const {
    Vec3 d{0.0};
    for (int a = 0; a < 3; ++a) {
      if (image_.points[a] < 2) continue;
      Index3 before = place, after = place;
      before[a] = std::max(0, place[a] - 1);
      after[a] = std::min(image_.points[a] - 1, place[a] + 1);
      const std::vector<double>& per_step = per_step_[as_size(a)];
      d[a] = (per_step.empty() ? 0.5 : per_step[as_size(place[a])]) * (read(after) - read(before));
    }
    return to_data_ * d;
  }

 private:
  const VolumeImage& image_;
  Mat3 to_data_{1.0};
  std::array<std::vector<double>, 3>
      per_step_;  ///< of uneven steps: 1 / m from the point before to that behind
};

// Range of the components of gradients, and the largest magnitude.
struct Spread {
  Vec3 lower{HUGE_VAL}, upper{-HUGE_VAL};
  double most = -HUGE_VAL;

  void include(const Vec3& gradient) {
    const double size = glm::length(gradient);
    if (!std::isfinite(size)) return;
    lower = glm::min(lower, gradient);
    upper = glm::max(upper, gradient);
    most = std::max(most, size);
  }
  void include(const Spread& other) {
    lower = glm::min(lower, other.lower);
    upper = glm::max(upper, other.upper);
    most = std::max(most, other.most);
  }
  // No component is nearer to zero than this.
  [[nodiscard]] double least() const {
    Vec3 nearest{0.0};
    for (int a = 0; a < 3; ++a) nearest[a] = std::max({0.0, lower[a], -upper[a]});
    return glm::length(nearest);
  }
};

std::size_t rows_of(const VolumeImage& image) { return as_size(image.points.y) * as_size(image.points.z); }

// The blocks of sparse numbers that have gradients: of several numbers, or with another one across a face.
std::vector<Index3> varied_blocks(const SparseNumbers& numbers, int threads) {
  const Index3 n = numbers.blocks();
  std::vector<std::vector<Index3>> layers(as_size(n.z));
  parallel_for(layers.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t layer = first; layer < last; ++layer) {
      for (int y = 0; y < n.y; ++y) {
        for (int x = 0; x < n.x; ++x) {
          const Index3 b(x, y, static_cast<int>(layer));
          const SparseBlock block = numbers.block(b);
          const auto differs = [&](const Index3& other) {
            const SparseBlock next = numbers.block(other);
            const bool same =
                next.constant == block.constant || (std::isnan(next.constant) && std::isnan(block.constant));
            return next.numbers != nullptr || !same;
          };
          bool varied = block.numbers != nullptr;
          for (int a = 0; a < 3 && !varied; ++a) {
            Index3 step(0);
            step[a] = 1;
            varied = (b[a] > 0 && differs(b - step)) || (b[a] + 1 < n[a] && differs(b + step));
          }
          if (varied) layers[layer].push_back(b);
        }
      }
    }
  });
  std::vector<Index3> blocks;
  for (const auto& layer : layers) blocks.insert(blocks.end(), layer.begin(), layer.end());
  return blocks;
}

// Of blocks, so that they have no more points than `most`, every such one is taken.
std::size_t block_stride(std::size_t blocks, std::size_t most) {
  return std::max<std::size_t>(1, (blocks * kBlockVoxels + most - 1) / most);
}

// Calls f(number, gradient) for the points of a block.
template <typename F>
void visit_block(const SparseNumbers& numbers, const PointGradients& gradients, const Index3& block,
                 SparseReader& reader, F f) {
  const PointBox box = numbers.points_of(block);
  const auto read = [&](const Index3& p) { return static_cast<double>(reader.at(p)); };
  for (int z = box.first.z; z < box.end.z; ++z) {
    for (int y = box.first.y; y < box.end.y; ++y) {
      for (int x = box.first.x; x < box.end.x; ++x) f(read({x, y, z}), gradients.at(Index3(x, y, z), read));
    }
  }
}

double highest_sparse_gradient(const VolumeImage& image, int threads) {
  constexpr std::size_t kMostSparse = std::size_t{1} << 23U;  // points: their numbers are found one by one
  const PointGradients gradients(image);
  const std::vector<Index3> blocks = varied_blocks(*image.sparse, threads);
  const std::size_t stride = block_stride(blocks.size(), kMostSparse);
  std::vector<double> most((blocks.size() + stride - 1) / stride, 0.0);
  parallel_for(most.size(), threads, [&](std::size_t first, std::size_t last) {
    SparseReader reader(*image.sparse);
    for (std::size_t i = first; i < last; ++i) {
      visit_block(*image.sparse, gradients, blocks[i * stride], reader, [&](double, const Vec3& gradient) {
        const double size = glm::length(gradient);
        if (std::isfinite(size)) most[i] = std::max(most[i], size);
      });
    }
  });
  return most.empty() ? 0.0 : std::abs(image.scale) * *std::max_element(most.begin(), most.end());
}

// Pairs are counted in parts whose sum is one whatever threads there are.
constexpr std::size_t kParts = 16;
using Counts = std::vector<std::uint32_t>;

class PlaceCounter {
 public:
  explicit PlaceCounter(const PlaceHistogram& histogram)
      : range_(histogram.range), columns_(histogram.columns), rows_(histogram.rows) {}

  // Counts a value and a magnitude so many times.
  void add(Counts& counts, double value, double size, std::uint32_t times) const {
    const Vec2 scale = Vec2(columns_, rows_) / (range_.upper - range_.lower);
    const Vec2 bin = (Vec2(value, size) - range_.lower) * scale;
    if (!std::isfinite(bin.x) || !std::isfinite(bin.y)) return;
    const auto last_column = static_cast<double>(columns_ - 1), last_row = static_cast<double>(rows_ - 1);
    const auto column = static_cast<std::size_t>(std::clamp(bin.x, 0.0, last_column));
    const auto row = static_cast<std::size_t>(std::clamp(bin.y, 0.0, last_row));
    counts[column + columns_ * row] += times;
  }

 private:
  PlaceRange range_;
  std::size_t columns_, rows_;
};

void count_sparse(const VolumeImage& image, const PlaceCounter& counter, std::size_t most, int threads,
                  std::vector<Counts>& parts) {
  const SparseNumbers& numbers = *image.sparse;
  const PointGradients gradients(image);
  const std::vector<Index3> blocks = varied_blocks(numbers, threads);
  const std::size_t stride = block_stride(blocks.size(), most);
  const auto value_of = [&](double number) { return image.offset + image.scale * number; };
  const Index3 n = numbers.blocks();
  const auto number_of = [&](const Index3& b) { return index_in(n, b); };
  std::vector<bool> varied(number_of(n - 1) + 1, false);
  for (const Index3& b : blocks) varied[number_of(b)] = true;
  parallel_for(kParts, threads, [&](std::size_t first, std::size_t last) {
    SparseReader reader(numbers);
    for (std::size_t part = first; part < last; ++part) {
      for (std::size_t i = part * stride; i < blocks.size(); i += kParts * stride) {
        visit_block(numbers, gradients, blocks[i], reader, [&](double number, const Vec3& gradient) {
          counter.add(parts[part], value_of(number), std::abs(image.scale) * glm::length(gradient), 1);
        });
      }
      for (int z = static_cast<int>(part); z < n.z; z += static_cast<int>(kParts)) {
        for (int y = 0; y < n.y; ++y) {
          for (int x = 0; x < n.x; ++x) {
            const Index3 b(x, y, z);
            if (varied[number_of(b)]) continue;
            const auto times = static_cast<std::uint32_t>(numbers.points_of(b).count() / stride);
            counter.add(parts[part], value_of(static_cast<double>(numbers.block(b).constant)), 0.0, times);
          }
        }
      }
    }
  });
}

}  // namespace

double highest_gradient(const VolumeImage& image, int threads) {
  if (image.sparse) return highest_sparse_gradient(image, threads);
  const PointGradients gradients(image);
  // Of large volumes rows evenly taken, so that nobody waits for long.
  const std::size_t stride = (image.point_count() + kMostMeasured - 1) / kMostMeasured;
  std::vector<double> most(std::max<std::size_t>(1, rows_of(image) / stride), 0.0);
  parallel_for(most.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const std::size_t row = i * stride;
      const int y = static_cast<int>(row) % image.points.y, z = static_cast<int>(row) / image.points.y;
      for (int x = 0; x < image.points.x; ++x) {
        const double size = glm::length(gradients.at(x, y, z));
        if (std::isfinite(size)) most[i] = std::max(most[i], size);
      }
    }
  });
  return std::abs(image.scale) * *std::max_element(most.begin(), most.end());
}

PlaceRange place_range(const VolumeImage& image, int threads) {
  PlaceRange range{.lower = {0.0, 0.0}, .upper = {1.0, 1.0}};
  if (image.lowest > image.highest) return range;
  range.lower.x = image.lowest;
  range.upper.x = image.lowest < image.highest ? image.highest : image.lowest + 1.0;
  const double most = highest_gradient(image, threads);
  if (most > 0.0) range.upper.y = most;
  return range;
}

GradientRanges gradient_ranges(const VolumeImage& image, const Index3& bricks, int threads) {
  const PointGradients gradients(image);
  GradientRanges result;
  result.ranges.resize(count_of(bricks));
  const double scale = std::abs(image.scale);
  // A row of bricks at a time: the points between two bricks count for both.
  parallel_for(as_size(bricks.y) * as_size(bricks.z), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t row = first; row < last; ++row) {
      const int by = static_cast<int>(row) % bricks.y, bz = static_cast<int>(row) / bricks.y;
      const int y1 = std::min(image.points.y, kBrickCells * (by + 1) + 1);
      const int z1 = std::min(image.points.z, kBrickCells * (bz + 1) + 1);
      std::vector<Spread> spreads(as_size(bricks.x));
      for (int z = kBrickCells * bz; z < z1; ++z) {
        for (int y = kBrickCells * by; y < y1; ++y) {
          for (int x = 0; x < image.points.x; ++x) {
            const Vec3 gradient = gradients.at(x, y, z);
            const int bx = std::min(x / kBrickCells, bricks.x - 1);
            spreads[as_size(bx)].include(gradient);
            if (x % kBrickCells == 0 && x > 0 && bx == x / kBrickCells)
              spreads[as_size(bx - 1)].include(gradient);
          }
        }
      }
      for (std::size_t bx = 0; bx < spreads.size(); ++bx) {
        const Spread& spread = spreads[bx];
        if (!(spread.most >= 0.0)) continue;
        result.ranges[bx + spreads.size() * row] = {scale * spread.least(), scale * spread.most};
      }
    }
  });
  return result;
}

PlaceHistogram count_places(const VolumeImage& image, std::size_t columns, std::size_t rows, std::size_t most,
                            int threads) {
  PALPATE_CHECK(columns >= 1 && rows >= 1 && most >= 1);
  PlaceHistogram histogram{place_range(image, threads), columns, rows, {}};
  histogram.counts.resize(columns * rows, 0);
  const PlaceCounter counter(histogram);
  std::vector<Counts> parts(kParts, Counts(columns * rows, 0));
  if (image.sparse) {
    count_sparse(image, counter, most, threads, parts);
  } else {
    const PointGradients gradients(image);
    const std::size_t stride = (image.point_count() + most - 1) / most,
                      taken = std::max<std::size_t>(1, rows_of(image) / stride);
    parallel_for(kParts, threads, [&](std::size_t first, std::size_t last) {
      for (std::size_t part = first; part < last; ++part) {
        for (std::size_t i = part; i < taken; i += kParts) {
          const std::size_t row = i * stride;
          const int y = static_cast<int>(row) % image.points.y, z = static_cast<int>(row) / image.points.y;
          for (int x = 0; x < image.points.x; ++x) {
            const double value = image.value(as_size(x) + as_size(image.points.x) * row);
            counter.add(parts[part], value, std::abs(image.scale) * glm::length(gradients.at(x, y, z)), 1);
          }
        }
      }
    });
  }
  for (const Counts& part : parts) {
    for (std::size_t i = 0; i < part.size(); ++i) histogram.counts[i] += part[i];
  }
  return histogram;
}

}  // namespace palpate
