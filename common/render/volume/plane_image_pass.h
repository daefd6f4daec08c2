/// Draws the values on the planes of a volume (shaders/volume/plane_image.frag).
#pragma once

#include <span>
#include <string>

#include "common/render/camera.h"
#include "common/render/frame_block.h"
#include "common/render/gl/object.h"
#include "common/render/volume/volume_view.h"

namespace palpate {

/// Part of VolumePass, whose textures and blocks it uses. Needs the context current in which it was made.
class PlaneImagePass {
 public:
  /// Into the framebuffer that is bound, opaque, the nearest in front.
  /// @pre The textures of the voxels and of the tables, and the blocks of the volume and of its lenses are
  /// bound where shaders/volume/ want them. shows_planes(view).
  /// @param defines of the shader, the same whenever it is called.
  void draw(const VolumeView& view, const SceneFrame& frame, const FrameBlock& block,
            std::span<const std::string> defines);

 private:
  GlProgram program_;  // compiled at the first use
};

}  // namespace palpate
