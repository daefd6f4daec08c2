#include "common/render/glyph/arrow_pass.h"

#include <epoxy/gl.h>

#include "common/render/gl/program.h"
#include "common/render/glyph/arrow_mesh.h"

namespace palpate {
namespace {

// Of shaders/glyph/arrow.vert.
constexpr GLint kOpacity = 0;
constexpr GLuint kArrowsBinding = 0;
// Facets about the axis: no corner shows at the sizes of glyphs.
constexpr int kSides = 32;

void describe(const GlVertexArray& array, GLuint location, GLint components, std::size_t offset) {
  glEnableVertexArrayAttrib(array.name(), location);
  glVertexArrayAttribFormat(array.name(), location, components, GL_FLOAT, GL_FALSE,
                            static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(array.name(), location, 0);
}

}  // namespace

void ArrowPass::draw(std::span<const ArrowInstance> arrows, float hidden_opacity, GlyphPart part) {
  if (arrows.empty()) return;
  if (!program_) {
    program_ = compile_program("glyph/arrow.vert", "glyph/arrow.frag");
    const auto mesh = make_arrow_mesh(kSides);
    mesh_ = make_buffer(std::span<const ArrowVertex>(mesh));
    corner_count_ = mesh.size();
    vertex_array_ = make_vertex_array();
    glVertexArrayVertexBuffer(vertex_array_.name(), 0, mesh_.name(), 0, sizeof(ArrowVertex));
    describe(vertex_array_, 0, 2, offsetof(ArrowVertex, circle));
    describe(vertex_array_, 1, 2, offsetof(ArrowVertex, along));
    describe(vertex_array_, 2, 2, offsetof(ArrowVertex, radial));
    describe(vertex_array_, 3, 3, offsetof(ArrowVertex, facing));
  }
  const GlBuffer instances = make_buffer(arrows);
  glUseProgram(program_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kArrowsBinding, instances.name());
  glBindVertexArray(vertex_array_.name());
  draw_glyph_part(part, hidden_opacity, [&](float opacity) {
    glUniform1f(kOpacity, opacity);
    glDrawArraysInstanced(GL_TRIANGLES, 0, static_cast<GLsizei>(corner_count_),
                          static_cast<GLsizei>(arrows.size()));
  });
}

}  // namespace palpate
