#include "common/render/tensor/tensor_glyph_pass.h"

#include <algorithm>

namespace palpate {
namespace {

// Glyphs longer than this show the corners of a coarse mesh [pixels, half axis].
constexpr double kLargeGlyph = 20.0;

bool same_glyphs(const TensorView& a, const TensorView& b) {
  return a.image == b.image && a.position == b.position && a.slices == b.slices && a.color == b.color &&
         a.glyphs == b.glyphs && a.glyph_least_fa == b.glyph_least_fa;
}

// Those whose ball reaches into the picture.
std::vector<TensorGlyph> in_picture(const std::vector<TensorGlyph>& glyphs, float reach,
                                    const glm::mat4& clip_from_scene) {
  // Planes of the picture's sides in the scene frame: w +- x, w +- y >= 0.
  std::vector<glm::vec4> planes;
  const glm::mat4 rows = glm::transpose(clip_from_scene);
  for (const int side : {0, 1}) {
    for (const float sign : {1.0F, -1.0F}) {
      const glm::vec4 plane = rows[3] + sign * rows[side];
      planes.push_back(plane / glm::length(Vec3f(plane)));
    }
  }
  std::vector<TensorGlyph> seen;
  seen.reserve(glyphs.size());
  for (const TensorGlyph& glyph : glyphs) {
    bool inside = true;
    for (const glm::vec4& plane : planes) inside &= glm::dot(plane, glm::vec4(glyph.center, 1.0F)) >= -reach;
    if (inside) seen.push_back(glyph);
  }
  return seen;
}

}  // namespace

void TensorGlyphPass::update(const TensorView& view, const SceneFrame& frame, const Index3& stride) {
  const bool same = view_ && same_glyphs(*view_, view) && stride_ == stride &&
                    frame_.center == frame.center && frame_.exponent == frame.exponent;
  if (same) return;
  glyphs_ = make_slice_glyphs(view, frame, stride);
  view_ = view;
  frame_ = frame;
  stride_ = stride;
}

void TensorGlyphPass::draw(const TensorView& view, const SceneFrame& frame, const Camera& camera,
                           const ViewTransform& transform, double pixel) {
  if (view.glyphs == GlyphShape::kNone) return;
  update(view, frame, glyph_stride(*view.image, 1e-3 * view.glyph_spacing * camera.view_height));
  float reach = 0.0F;
  for (const TensorGlyph& glyph : glyphs_) {
    reach =
        std::max({reach, glm::length(glyph.axis_x), glm::length(glyph.axis_y), glm::length(glyph.axis_z)});
  }
  const std::vector<TensorGlyph> seen = in_picture(glyphs_, reach, glm::mat4(transform.clip_from_scene));
  mesh_.draw(seen, static_cast<double>(reach) > kLargeGlyph * pixel);
}

}  // namespace palpate
