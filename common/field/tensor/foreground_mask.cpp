#include "common/field/tensor/foreground_mask.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/field/value_histogram.h"
#include "common/math/lattice.h"

namespace palpate {
namespace {

using Axes = std::array<bool, 3>;

/// Of every voxel, the faces of the image that it lies at: bit 2 axis of the first, bit 2 axis + 1 of the
/// last voxels along an axis.
std::vector<std::uint8_t> faces_of(const Index3& points) {
  std::vector<std::uint8_t> faces;
  faces.reserve(count_of(points));
  const auto along = [&](int i, int axis) {
    const unsigned first = i == 0 ? 1U : 0U, last = i + 1 == points[axis] ? 2U : 0U;
    return (first | last) << (2 * axis);
  };
  for (int k = 0; k < points.z; ++k) {
    for (int j = 0; j < points.y; ++j) {
      const unsigned row = along(j, 1) | along(k, 2);
      for (int i = 0; i < points.x; ++i) faces.push_back(static_cast<std::uint8_t>(row | along(i, 0)));
    }
  }
  return faces;
}

/// The voxels of an image and their neighbours through faces along some of its axes.
class Neighbours {
 public:
  Neighbours(const Index3& points, std::span<const std::uint8_t> faces, const Axes& along)
      : faces_(faces), stride_{1, as_size(points.x), as_size(points.x) * as_size(points.y)} {
    for (std::size_t axis = 0; axis < 3; ++axis) seen_ |= along[axis] ? 3U << (2 * axis) : 0U;
  }

  /// Calls `visit` for each neighbour; true where the voxel lies at the border of the image.
  template <typename Visit>
  bool each(std::size_t voxel, const Visit& visit) const {
    const unsigned open = seen_ & ~unsigned{faces_[voxel]};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if ((open & 1U << (2 * axis)) != 0) visit(voxel - stride_[axis]);
      if ((open & 2U << (2 * axis)) != 0) visit(voxel + stride_[axis]);
    }
    return open != seen_;
  }

 private:
  std::span<const std::uint8_t> faces_;
  std::array<std::size_t, 3> stride_;
  unsigned seen_ = 0;  ///< bits of `faces_` that count
};

/// Parts of equal value that hang together, found one after the other.
class Parts {
 public:
  Parts(const Index3& points, std::span<const std::uint8_t> faces, const Axes& along)
      : neighbours_(points, faces, along), seen_(faces.size(), 0) {}

  struct Part {
    std::vector<std::size_t> voxels;
    bool at_border = false;
  };

  /// The part of `start`; empty where it was found before.
  Part take(std::size_t start, std::span<const std::uint8_t> mask) {
    Part part;
    if (seen_[start] != 0) return part;
    seen_[start] = 1;
    part.voxels.push_back(start);
    for (std::size_t next = 0; next < part.voxels.size(); ++next) {
      const bool border = neighbours_.each(part.voxels[next], [&](std::size_t other) {
        if (seen_[other] != 0 || mask[other] != mask[start]) return;
        seen_[other] = 1;
        part.voxels.push_back(other);
      });
      part.at_border = part.at_border || border;
    }
    return part;
  }

 private:
  Neighbours neighbours_;
  std::vector<std::uint8_t> seen_;
};

double threshold_of(std::span<const float> values) {
  constexpr std::size_t kBins = 1024;
  constexpr double kBright = 0.98;
  double lower = HUGE_VAL, upper = -HUGE_VAL;
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    lower = std::min(lower, static_cast<double>(value));
    upper = std::max(upper, static_cast<double>(value));
  }
  if (!(lower < upper)) return -HUGE_VAL;
  const auto histogram_to = [&](double end) {
    return count_values(
        values.size(),
        [&, end](std::size_t i) {
          return std::isfinite(values[i]) ? std::min(static_cast<double>(values[i]), end) : std::nan("");
        },
        lower, end, kBins, 1);
  };
  const double bright = value_below_which(histogram_to(upper), kBright, lower);
  return otsu_threshold(histogram_to(bright > lower ? bright : upper));
}

/// Fills what is enclosed along `along`: parts of the background that do not reach the border of the image,
/// or of its slices.
void fill_holes(const Index3& points, std::span<const std::uint8_t> faces, const Axes& along,
                std::vector<std::uint8_t>& mask) {
  Parts outside(points, faces, along);
  for (std::size_t voxel = 0; voxel < mask.size(); ++voxel) {
    if (mask[voxel] != 0) continue;
    const Parts::Part part = outside.take(voxel, mask);
    if (part.at_border) continue;
    // Marked 2 until the end: parts are told apart by value.
    for (const std::size_t hole : part.voxels) mask[hole] = 2;
  }
  for (std::uint8_t& value : mask) value = value != 0 ? 1 : 0;
}

}  // namespace

std::vector<std::uint8_t> foreground_mask(std::span<const float> values, const Index3& points) {
  PALPATE_CHECK(values.size() == count_of(points));
  const double threshold = threshold_of(values);
  std::vector<std::uint8_t> bright(values.size());
  std::transform(values.begin(), values.end(), bright.begin(), [threshold](float value) {
    return static_cast<std::uint8_t>(std::isfinite(value) && static_cast<double>(value) > threshold ? 1 : 0);
  });
  std::vector<std::uint8_t> mask(values.size(), 0);
  const std::vector<std::uint8_t> faces = faces_of(points);
  Parts parts(points, faces, {true, true, true});
  std::vector<std::size_t> largest;
  for (std::size_t voxel = 0; voxel < values.size(); ++voxel) {
    if (bright[voxel] == 0) continue;
    Parts::Part part = parts.take(voxel, bright);
    if (part.voxels.size() > largest.size()) largest = std::move(part.voxels);
  }
  for (const std::size_t voxel : largest) mask[voxel] = 1;
  // In a slice too: what is dark inside a head is open to the outside somewhere, through the base of the
  // skull.
  fill_holes(points, faces, {true, true, true}, mask);
  for (const Axes& slice : {Axes{true, true, false}, Axes{true, false, true}, Axes{false, true, true}})
    fill_holes(points, faces, slice, mask);
  return mask;
}

}  // namespace palpate
