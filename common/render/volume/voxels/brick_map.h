/// Where a volume shows nothing, for rays to leap over.
///
/// The volume is cut into bricks of kBrickCells cells an axis. A brick's range of values holds those of all
/// points of its cells, so its interpolated values lie there too; it is empty where the transfer function is
/// clear on all of the range. Each empty brick knows its distance to the nearest one that is not, in bricks
/// and by the largest of the three axes (Chebyshev): all bricks nearer than that are empty, and a ray leaves
/// them in one step (Zuiderveld, Koning and Viergever 1992).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/math/vec.h"
#include "common/render/volume/table/preintegration.h"
#include "common/render/volume/voxels/region_table.h"
#include "common/render/volume/voxels/value_gradient.h"
#include "common/render/volume/voxels/volume_image.h"

namespace palpate {

inline constexpr int kBrickCells = 8;

/// Ranges of values of the bricks, as the numbers that the image stores. Depends on the image alone.
struct BrickRanges {
  struct Range {
    float lowest = 1.0F;
    float highest = -1.0F;  ///< below `lowest` where the brick has no finite value
  };
  Index3 bricks{0};
  std::vector<Range> ranges;  ///< x fastest
};
[[nodiscard]] BrickRanges brick_ranges(const VolumeImage& image, int threads = 0);

/// For each brick 0 where something may be seen, else its distance to such a brick, at most 255.
/// @param entries of the preintegrated table, at equally spaced numbers from `lower` to `upper`; beyond them
/// the end ones hold. @pre entries.size() >= 2, lower < upper.
[[nodiscard]] std::vector<std::uint8_t> empty_distances(const BrickRanges& ranges,
                                                        std::span<const OpticalEntry> entries, double lower,
                                                        double upper);

/// The same for a transfer function of value and gradient magnitude: a brick is empty where the table is
/// clear for all pairs of its values and its magnitudes.
/// @param gradients of the same bricks. @param numbers at the first and the last column of the table.
/// @param highest gradient magnitude at its last row.
[[nodiscard]] std::vector<std::uint8_t> empty_distances(const BrickRanges& ranges,
                                                        const GradientRanges& gradients,
                                                        const RegionTable& table, double lower, double upper,
                                                        double highest);

/// Which of the bricks between others along x that show something show nothing, as a share; 0 where none lie
/// between others.
/// @param distances of empty_distances(), one or several maps one after another: bricks that show something
/// in any.
[[nodiscard]] double gap_share(const Index3& bricks, std::span<const std::uint8_t> distances);

}  // namespace palpate
