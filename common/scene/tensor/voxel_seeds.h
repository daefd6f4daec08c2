/// Seeds in the voxels of an image.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "common/field/data_set.h"
#include "common/math/vec.h"

namespace palpate {

/// `per_voxel` seeds in each voxel whose centre `wanted` takes: one at its centre, more at random places
/// in it. The places depend on `random_seed`, the voxel and their number alone (a counter-based generator),
/// not on which other voxels are wanted. Data coordinates, in the order of the voxels.
/// @pre per_voxel >= 1. @throws Error (usage) for more than `most` seeds.
[[nodiscard]] std::vector<Vec3> voxel_seeds(const UniformTopology& image,
                                            const std::function<bool(const Vec3& center)>& wanted,
                                            int per_voxel, std::uint64_t random_seed, std::size_t most);

}  // namespace palpate
