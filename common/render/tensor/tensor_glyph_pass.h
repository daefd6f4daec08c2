/// Draws the tensor glyphs of slices: one mesh, instanced and shaped by the vertex shader.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "common/render/camera.h"
#include "common/render/tensor/tensor_glyph_mesh.h"

namespace palpate {

/// Glyphs are made again when the slices move or the view comes so near that more of them have room; of
/// those, only the ones in the picture are drawn, with more facets where they are large.
class TensorGlyphPass {
 public:
  /// Draws the glyphs of `view`, opaque and with depth.
  /// @param camera and transform of the frame. @param pixel N at the focal point.
  /// @pre The frame's uniform block is bound to 0; view.image is not null.
  void draw(const TensorView& view, const SceneFrame& frame, const Camera& camera,
            const ViewTransform& transform, double pixel);

 private:
  void update(const TensorView& view, const SceneFrame& frame, const Index3& stride);

  TensorGlyphMesh mesh_;
  std::vector<TensorGlyph> glyphs_;

  // What the glyphs were made from.
  std::optional<TensorView> view_;
  SceneFrame frame_;
  Index3 stride_{0};
};

}  // namespace palpate
