#include "common/render/volume/voxels/seen_bricks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "common/base/index.h"
#include "common/math/lattice.h"
#include "common/render/volume/table/preintegration.h"
#include "common/render/volume/volume_block.h"
#include "common/render/volume/voxels/region_table.h"

namespace palpate {

std::vector<std::uint8_t> distances_to_seen(const VolumeView& view, const BrickRanges& ranges) {
  const NumberRange numbers = table_range(view);
  std::vector<std::uint8_t> nearest(ranges.ranges.size(), std::numeric_limits<std::uint8_t>::max());
  const auto columns = as_size(view.table_entries);
  for (const FieldTransfer& transfer : transfers_of(view)) {
    if (transfer.field > 0) continue;
    const PlaceRange places = table_places(view, 0);
    const std::vector<OpticalEntry> entries =
        transfer.regions ? deepest_entries(make_region_table(*transfer.regions, places, columns))
                         : optical_entries(transfer.colors, places.lower.x, places.upper.x, columns,
                                           step_lengths(view).longest / opacity_length_of(view));
    const std::vector<std::uint8_t> distances =
        empty_distances(ranges, entries, numbers.lower, numbers.upper);
    for (std::size_t i = 0; i < nearest.size(); ++i) nearest[i] = std::min(nearest[i], distances[i]);
  }
  return nearest;
}

double hidden_share(const VolumeView& view, const BrickRanges& ranges, const VolumeView& coarser,
                    const BrickRanges& coarser_ranges) {
  const std::vector<std::uint8_t> fine = distances_to_seen(view, ranges),
                                  coarse = distances_to_seen(coarser, coarser_ranges);
  Index3 joined(1);  // cells of the volume in one of the coarser one
  for (int a = 0; a < 3; ++a) {
    const double ratio = glm::length(coarser.image->axes[a]) / glm::length(view.image->axes[a]);
    joined[a] = std::max(1, static_cast<int>(std::lround(ratio)));
  }
  std::size_t seen = 0, hidden = 0;
  for (std::size_t i = 0; i < fine.size(); ++i) {
    if (fine[i] > 0) continue;
    ++seen;
    const Index3& n = ranges.bricks;
    const auto x = as_size(n.x), y = as_size(n.y);
    const Index3 here(static_cast<int>(i % x), static_cast<int>(i / x % y), static_cast<int>(i / x / y));
    const Index3 at = glm::min(here / joined, coarser_ranges.bricks - 1);
    if (coarse[index_in(coarser_ranges.bricks, at)] > 0) ++hidden;
  }
  return seen > 0 ? static_cast<double>(hidden) / static_cast<double>(seen) : 0.0;
}

}  // namespace palpate
