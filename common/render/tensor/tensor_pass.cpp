#include "common/render/tensor/tensor_pass.h"

#include "common/render/color/palette.h"

namespace palpate {

void TensorPass::draw(const SceneView& view, const SceneFrame& frame, const ViewTransform& transform,
                      float unit) {
  slices_.draw(*view.tensors, frame, palette_of(view.background), unit);
  glyphs_.draw(*view.tensors, frame, view.camera, transform, 1e-3 * transform.view_height / unit);
}

}  // namespace palpate
