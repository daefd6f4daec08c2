/// In which bricks of a volume something is seen, and how much of that coarser voxels hide.
#pragma once

#include <cstdint>
#include <vector>

#include "common/render/volume/volume_view.h"
#include "common/render/volume/voxels/brick_map.h"

namespace palpate {

/// For each brick of `ranges` its distance to the nearest one in which some transfer function of the view
/// shows something, as empty_distances(). @param ranges brick_ranges(*view.image).
[[nodiscard]] std::vector<std::uint8_t> distances_to_seen(const VolumeView& view, const BrickRanges& ranges);

/// Of the bricks in which something is seen, the share that lies where a coarser image shows nothing: thin things
/// are lost in means. A lower bound: what is lost beside something that is seen is not in it.
/// @param ranges brick_ranges() of the image of `view`. @param coarser the same view of means of its voxels.
[[nodiscard]] double hidden_share(const VolumeView& view, const BrickRanges& ranges,
                                  const VolumeView& coarser, const BrickRanges& coarser_ranges);

}  // namespace palpate
