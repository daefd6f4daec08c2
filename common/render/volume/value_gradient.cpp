#include "common/render/volume/value_gradient.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/base/check.h"
#include "common/base/parallel.h"
#include "common/math/power_of_two.h"
#include "common/render/volume/brick_map.h"

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
  }

  // (1) at x, y, z. NaN where a value lacks.
  [[nodiscard]] Vec3 at(int x, int y, int z) const {
    const Index3 place(x, y, z);
    Vec3 d{0.0};
    for (int a = 0; a < 3; ++a) {
      if (image_.points[a] < 2) continue;
      Index3 before = place, after = place;
      before[a] = std::max(0, place[a] - 1);
      after[a] = std::min(image_.points[a] - 1, place[a] + 1);
      d[a] = 0.5 * (number(after) - number(before));
    }
    return to_data_ * d;
  }

 private:
  [[nodiscard]] double number(const Index3& p) const {
    return image_.number(static_cast<std::size_t>(p.x) +
                         static_cast<std::size_t>(image_.points.x) *
                             (static_cast<std::size_t>(p.y) +
                              static_cast<std::size_t>(image_.points.y) * static_cast<std::size_t>(p.z)));
  }

  const VolumeImage& image_;
  Mat3 to_data_{1.0};
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

std::size_t rows_of(const VolumeImage& image) {
  return static_cast<std::size_t>(image.points.y) * static_cast<std::size_t>(image.points.z);
}

}  // namespace

double highest_gradient(const VolumeImage& image, int threads) {
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
  result.ranges.resize(static_cast<std::size_t>(bricks.x) * static_cast<std::size_t>(bricks.y) *
                       static_cast<std::size_t>(bricks.z));
  const double scale = std::abs(image.scale);
  // A row of bricks at a time: the points between two bricks count for both.
  parallel_for(static_cast<std::size_t>(bricks.y) * static_cast<std::size_t>(bricks.z), threads,
               [&](std::size_t first, std::size_t last) {
                 for (std::size_t row = first; row < last; ++row) {
                   const int by = static_cast<int>(row) % bricks.y, bz = static_cast<int>(row) / bricks.y;
                   const int y1 = std::min(image.points.y, kBrickCells * (by + 1) + 1);
                   const int z1 = std::min(image.points.z, kBrickCells * (bz + 1) + 1);
                   std::vector<Spread> spreads(static_cast<std::size_t>(bricks.x));
                   for (int z = kBrickCells * bz; z < z1; ++z) {
                     for (int y = kBrickCells * by; y < y1; ++y) {
                       for (int x = 0; x < image.points.x; ++x) {
                         const Vec3 gradient = gradients.at(x, y, z);
                         const int bx = std::min(x / kBrickCells, bricks.x - 1);
                         spreads[static_cast<std::size_t>(bx)].include(gradient);
                         if (x % kBrickCells == 0 && x > 0 && bx == x / kBrickCells)
                           spreads[static_cast<std::size_t>(bx - 1)].include(gradient);
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
  PALPATE_CHECK(columns >= 1 && rows >= 1);
  const PointGradients gradients(image);
  PlaceHistogram histogram{place_range(image, threads), columns, rows, {}};
  histogram.counts.resize(columns * rows, 0);
  const Vec2 scale = Vec2(columns, rows) / (histogram.range.upper - histogram.range.lower);
  const std::size_t stride = (image.point_count() + most - 1) / most,
                    taken = std::max<std::size_t>(1, rows_of(image) / stride);
  // Layers of rows have counts of their own; their sum is one whatever threads there are.
  constexpr std::size_t kParts = 16;
  std::vector<std::vector<std::uint32_t>> parts(kParts, std::vector<std::uint32_t>(columns * rows, 0));
  parallel_for(kParts, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t part = first; part < last; ++part) {
      for (std::size_t i = part; i < taken; i += kParts) {
        const std::size_t row = i * stride;
        const int y = static_cast<int>(row) % image.points.y, z = static_cast<int>(row) / image.points.y;
        for (int x = 0; x < image.points.x; ++x) {
          const double value =
              image.value(static_cast<std::size_t>(x) + static_cast<std::size_t>(image.points.x) * row);
          const double size = std::abs(image.scale) * glm::length(gradients.at(x, y, z));
          const Vec2 bin = (Vec2(value, size) - histogram.range.lower) * scale;
          if (!std::isfinite(bin.x) || !std::isfinite(bin.y)) continue;
          const auto column = static_cast<std::size_t>(std::clamp(bin.x, 0.0, columns - 1.0));
          const auto line = static_cast<std::size_t>(std::clamp(bin.y, 0.0, rows - 1.0));
          ++parts[part][column + columns * line];
        }
      }
    }
  });
  for (const std::vector<std::uint32_t>& part : parts) {
    for (std::size_t i = 0; i < part.size(); ++i) histogram.counts[i] += part[i];
  }
  return histogram;
}

}  // namespace palpate
