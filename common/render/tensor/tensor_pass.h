/// Draws a TensorView: slices, and glyphs on them.
#pragma once

#include "common/render/camera.h"
#include "common/render/scene_view.h"
#include "common/render/tensor/slice_pass.h"
#include "common/render/tensor/tensor_glyph_pass.h"

namespace palpate {

/// Needs the context current in which it was made.
class TensorPass {
 public:
  /// @param unit pixels in a thousandth of the picture's height.
  /// @pre view.tensors, with an image; the frame's uniform block is bound to 0.
  /// @throws Error (usage) where the image is larger than the driver's textures.
  void draw(const SceneView& view, const SceneFrame& frame, const ViewTransform& transform, float unit);

 private:
  SlicePass slices_;
  TensorGlyphPass glyphs_;
};

}  // namespace palpate
