#include "common/render/frame_block.h"

namespace palpate {

FrameBlock make_frame_block(const Camera& camera, const ViewTransform& transform, const Palette& colors,
                            bool depth_cue, int width, int height) {
  const bool perspective = camera.projection == Projection::kPerspective;
  FrameBlock block;
  block.clip_from_scene = glm::mat4(transform.clip_from_scene);
  block.eye = {Vec3f(transform.eye), perspective ? 1.0F : 0.0F};
  block.right = {Vec3f(camera.axes[0]), transform.eye_offset.x};
  block.up = {Vec3f(camera.axes[1]), transform.eye_offset.y};
  block.back = {Vec3f(camera.axes[2]), 0.0F};
  block.size = {width, height, transform.view_height / height, transform.distance};
  block.depth_cue = {transform.near_depth, transform.far_depth, depth_cue ? colors.fading : 0.0F,
                     colors.highlight};
  block.background_top = {colors.background.top, 1.0F};
  block.background_bottom = {colors.background.bottom, 1.0F};
  return block;
}

}  // namespace palpate
