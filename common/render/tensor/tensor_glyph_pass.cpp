#include "common/render/tensor/tensor_glyph_pass.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>

#include <epoxy/gl.h>

#include "common/render/gl/program.h"

namespace palpate {
namespace {

// Of shaders/tensor/glyph.vert.
constexpr GLuint kGlyphsBinding = 0, kAngles = 0;
constexpr int kFewBands = 6, kManyBands = 14;
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

TensorGlyphPass::Mesh TensorGlyphPass::make_mesh(int bands) {
  const int sides = 2 * bands;
  std::vector<glm::vec4> corners;
  std::vector<std::uint16_t> indices;
  for (int j = 0; j <= bands; ++j) {
    const double phi = std::numbers::pi * j / bands;
    // The poles to the last bit: a superquadric's exponents would make much of sin(pi) = 1e-16.
    const double sine = j == 0 || j == bands ? 0.0 : std::sin(phi);
    for (int i = 0; i < sides; ++i) {
      const double theta = 2.0 * std::numbers::pi * i / sides;
      const auto clean = [](double x) { return std::abs(x) < 1e-12 ? 0.0 : x; };
      corners.emplace_back(clean(std::cos(theta)), clean(std::sin(theta)), clean(std::cos(phi)), sine);
    }
  }
  const auto at = [sides](int i, int j) { return static_cast<std::uint16_t>(j * sides + i % sides); };
  for (int j = 0; j < bands; ++j) {
    for (int i = 0; i < sides; ++i) {
      // At the poles one of the two triangles has no area.
      if (j > 0) indices.insert(indices.end(), {at(i, j), at(i, j + 1), at(i + 1, j)});
      if (j + 1 < bands) indices.insert(indices.end(), {at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
    }
  }
  Mesh mesh;
  mesh.array = make_vertex_array();
  mesh.corners = make_buffer(std::span<const glm::vec4>(corners));
  mesh.indices = make_buffer(std::span<const std::uint16_t>(indices));
  mesh.index_count = static_cast<int>(indices.size());
  const GLuint array = mesh.array.name();
  glVertexArrayVertexBuffer(array, 0, mesh.corners.name(), 0, sizeof(glm::vec4));
  glVertexArrayElementBuffer(array, mesh.indices.name());
  glEnableVertexArrayAttrib(array, kAngles);
  glVertexArrayAttribFormat(array, kAngles, 4, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(array, kAngles, 0);
  return mesh;
}

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
  if (!program_) {
    program_ = compile_program("tensor/glyph.vert", "tensor/glyph.frag");
    coarse_ = make_mesh(kFewBands);
    fine_ = make_mesh(kManyBands);
  }
  update(view, frame, glyph_stride(*view.image, 1e-3 * view.glyph_spacing * camera.view_height));
  float reach = 0.0F;
  for (const TensorGlyph& glyph : glyphs_) {
    reach =
        std::max({reach, glm::length(glyph.axis_x), glm::length(glyph.axis_y), glm::length(glyph.axis_z)});
  }
  const std::vector<TensorGlyph> seen = in_picture(glyphs_, reach, glm::mat4(transform.clip_from_scene));
  if (seen.empty()) return;
  const Mesh& mesh = static_cast<double>(reach) > kLargeGlyph * pixel ? fine_ : coarse_;

  const GlBuffer instances = make_buffer(std::span<const TensorGlyph>(seen));
  glUseProgram(program_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kGlyphsBinding, instances.name());
  glBindVertexArray(mesh.array.name());
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glEnable(GL_CULL_FACE);
  glDrawElementsInstanced(GL_TRIANGLES, mesh.index_count, GL_UNSIGNED_SHORT, nullptr,
                          static_cast<GLsizei>(seen.size()));
  glDisable(GL_CULL_FACE);
}

}  // namespace palpate
