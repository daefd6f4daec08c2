/// Reads an image of one number a voxel as a mask.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/field/voxel_mask.h"

namespace palpate {

struct MaskFile {
  std::shared_ptr<const VoxelMask> mask;  ///< not null
  std::string file;
  std::vector<std::string> notes;  ///< what the user should know of its place
};

/// @param left_handed LoadRequest::left_handed.
/// @throws Error (bad input): no image of even steps, several volumes or numbers a voxel, or no voxel above
/// 0.5; Cancelled.
[[nodiscard]] MaskFile read_mask(const std::filesystem::path& file, Progress* progress,
                                 bool left_handed = false);

/// @throws Error (bad input) where no voxel of the mask lies in `image`.
void check_overlap(const MaskFile& mask, const UniformTopology& image);

}  // namespace palpate
