/// Draws a slice (slice_raster.h) behind all else.
#pragma once

#include <optional>

#include "common/render/camera.h"
#include "common/render/gl/object.h"
#include "common/render/slice/slice_view.h"

namespace palpate {

/// Keeps what it has uploaded while slice and camera stay. Needs the context current in which it was made.
class VolumeSlicePass {
 public:
  /// Over the framebuffer that is bound, of this size, without depth.
  void draw(const SliceView& slice, const Camera& camera, int width, int height);

 private:
  GlProgram program_;  // compiled at the first use
  GlVertexArray no_vertices_;
  GlTexture texture_;
  std::optional<SliceView> shown_;
  Camera camera_;
  int width_ = 0, height_ = 0;
};

}  // namespace palpate
