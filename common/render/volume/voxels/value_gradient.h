/// How fast the values of a volume change: what transfer functions of value and gradient magnitude need to
/// know of it.
///
/// Symbols.  g grid coordinates; v(g) trilinear value, beyond the points that of the nearest place; A columns
/// of the axes. Differences go one voxel to either side,
///
///   grad v = A^-T d,   d_a(g) = (v(g + e_a) - v(g - e_a)) / 2                                        (1)
///
/// as the shaders have it (shaders/volume/slope.glsl). Between points (1) is the trilinear course of its
/// values at the points, so the magnitudes of a cell are at most those at its corners; from below they are
/// bounded by the least absolute value of each component.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/field/transfer/region_transfer.h"
#include "common/math/vec.h"
#include "common/render/volume/voxels/volume_image.h"

namespace palpate {

/// The largest finite magnitude at any point [value / data unit]; 0 where there is none. Of more than 2^26
/// points so many are looked at, in rows evenly taken; of sparse ones 2^23, in blocks evenly taken of those
/// that differ from each other or in themselves: there are no gradients elsewhere.
[[nodiscard]] double highest_gradient(const VolumeImage& image, int threads = 0);

/// The ranges of values and magnitudes of a volume: from its lowest to its highest value, from 0 on. Of one
/// value, or without a gradient, as wide as 1.
[[nodiscard]] PlaceRange place_range(const VolumeImage& image, int threads = 0);

/// Bounds of the magnitudes of the bricks of BrickRanges [value / data unit].
struct GradientRanges {
  struct Range {
    double lowest = 1.0;
    double highest = -1.0;  ///< below `lowest` where the brick has none
  };
  std::vector<Range> ranges;  ///< x fastest
};
[[nodiscard]] GradientRanges gradient_ranges(const VolumeImage& image, const Index3& bricks, int threads = 0);

/// How often pairs of value and magnitude occur.
struct PlaceHistogram {
  PlaceRange range;
  std::size_t columns = 0, rows = 0;  ///< bins of values and of magnitudes, of equal widths
  std::vector<std::uint32_t> counts;  ///< columns * rows, values fastest
};
/// Of all points, or where these are more than `most` of as many rows of points, evenly taken. Of a sparse
/// image those that differ are taken by blocks, and count against `most` alone; blocks of one number count as
/// often as if they were taken like them. The result does not depend on the number of threads.
[[nodiscard]] PlaceHistogram count_places(const VolumeImage& image, std::size_t columns, std::size_t rows,
                                          std::size_t most, int threads = 0);

}  // namespace palpate
