/// What all passes of one picture share, as the shaders get it (shaders/include/frame.glsl).
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "common/render/camera.h"
#include "common/render/color/palette.h"

namespace palpate {

/// Laid out as a std140 uniform block, bound to 0. Scene frame N; pixels of the framebuffer drawn to.
struct FrameBlock {
  glm::mat4 clip_from_scene{1.0F};
  glm::vec4 eye{0.0F};    ///< xyz position; w 1 perspective, 0 orthographic
  glm::vec4 right{0.0F};  ///< xyz unit axes of the camera; w: Camera::eye_offset along it [N]
  glm::vec4 up{0.0F};     ///< likewise
  glm::vec4 back{0.0F};
  glm::vec4 size{0.0F};       ///< width, height [pixels]; N a pixel at the focal point; focal distance
  glm::vec4 depth_cue{0.0F};  ///< nearest and farthest depth; fading at the far end; strength of highlights
  glm::vec4 background_top{0.0F}, background_bottom{0.0F};  ///< sRGB

  bool operator==(const FrameBlock&) const = default;
};

/// @param width, height of the framebuffer [pixels].
[[nodiscard]] FrameBlock make_frame_block(const Camera& camera, const ViewTransform& transform,
                                          const Palette& colors, bool depth_cue, int width, int height);

}  // namespace palpate
