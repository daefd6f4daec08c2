#include "common/render/tensor/tensor_glyph_mesh.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <epoxy/gl.h>

#include "common/render/gl/program.h"

namespace palpate {
namespace {

// Of shaders/tensor/glyph.*.
constexpr GLuint kGlyphsBinding = 0, kAngles = 0;
constexpr GLint kOpacity = 0;
constexpr int kFewBands = 6, kManyBands = 14;

}  // namespace

TensorGlyphMesh::Mesh TensorGlyphMesh::make_mesh(int bands) {
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
  describe_attribute(array, kAngles, 4, 0);
  return mesh;
}

void TensorGlyphMesh::draw(std::span<const TensorGlyph> glyphs, bool fine, float hidden_opacity,
                           GlyphPart part) {
  if (glyphs.empty()) return;
  if (!program_) {
    program_ = compile_program("tensor/glyph.vert", "tensor/glyph.frag");
    coarse_ = make_mesh(kFewBands);
    fine_ = make_mesh(kManyBands);
  }
  const Mesh& mesh = fine ? fine_ : coarse_;
  const GlBuffer instances = make_buffer(glyphs);
  glUseProgram(program_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kGlyphsBinding, instances.name());
  glBindVertexArray(mesh.array.name());
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glEnable(GL_CULL_FACE);
  draw_glyph_part(part, hidden_opacity, [&](float opacity) {
    glUniform1f(kOpacity, opacity);
    glDrawElementsInstanced(GL_TRIANGLES, mesh.index_count, GL_UNSIGNED_SHORT, nullptr,
                            static_cast<GLsizei>(glyphs.size()));
  });
  glDisable(GL_CULL_FACE);
}

}  // namespace palpate
