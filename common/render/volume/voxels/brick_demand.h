/// Which bricks of a volume a picture looks up, the most urgent ones first.
#pragma once

#include <cstddef>
#include <vector>

#include <glm/mat4x4.hpp>

#include "common/render/camera.h"
#include "common/render/frame_block.h"
#include "common/render/volume/voxels/voxel_bricks.h"

namespace palpate {

/// From where a picture is taken.
struct BrickSight {
  glm::mat4 clip_from_scene{1.0F};
  SceneFrame frame;
  double aspect = 1.0;  ///< width over height

  [[nodiscard]] bool operator==(const BrickSight& other) const;
};
[[nodiscard]] BrickSight make_brick_sight(const FrameBlock& block, const SceneFrame& frame);

/// Those of the needed bricks that rays through the picture may meet: lenses that show something first, then
/// from front to back. All of them where lenses enlarge, and show what lies elsewhere.
/// @param needed needed_bricks() of `view`, whose image is the one in bricks.
[[nodiscard]] std::vector<std::size_t> bricks_in_sight(const VolumeView& view,
                                                       const std::vector<bool>& needed,
                                                       const BrickLayout& layout, const BrickSight& sight);

}  // namespace palpate
