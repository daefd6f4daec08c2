/// Draws slices through an image of tensors, and through a scalar image below them: textured rectangles
/// (shaders/tensor/slice.*).
#pragma once

#include <memory>
#include <optional>

#include "common/render/camera.h"
#include "common/render/color/palette.h"
#include "common/render/gl/object.h"
#include "common/render/tensor/tensor_view.h"

namespace palpate {

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

}  // namespace palpate
