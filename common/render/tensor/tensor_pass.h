/// Draws a TensorView: slices, and glyphs on them.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "common/render/camera.h"
#include "common/render/color/color_map.h"
#include "common/render/color/palette.h"
#include "common/render/gl/object.h"
#include "common/render/scene_view.h"
#include "common/render/tensor/tensor_glyph_mesh.h"
#include "common/render/tensor/tensor_view.h"

namespace palpate {

// Draws slices through an image of tensors, and through a scalar image below them: textured rectangles
// (shaders/tensor/slice.*).

class SlicePass {
 public:
  /// Draws the slices of `view`, opaque and with depth, and uploads voxels when they are others.
  /// @param unit pixels in a thousandth of the picture's height.
  /// @pre The frame's uniform block is bound to 0; view.image is not null.
  /// @throws Error (usage) where an image is larger than the driver's textures.
  void draw(const TensorView& view, const SceneFrame& frame, const Palette& colors, float unit);

 private:
  void upload(const TensorView& view);
  void upload_underlay(const VolumeImage& image);
  void set_underlay(const TensorView& view);

  GlProgram program_;  // compiled at the first use
  GlVertexArray no_vertices_;
  GlTexture voxels_, under_;

  // What the texture was made from.
  std::shared_ptr<const TensorVoxels> image_;
  std::optional<TensorColor> color_;
  std::shared_ptr<const VolumeImage> under_image_;
};

// Draws the tensor glyphs of slices: one mesh, instanced and shaped by the vertex shader.

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
