#include "common/render/glyph/sphere_pass.h"

#include <epoxy/gl.h>

#include "common/render/gl/program.h"

namespace palpate {
namespace {
// Of shaders/glyph/sphere.vert.
constexpr GLint kHaloUniform = 0, kOpacityUniform = 1;
constexpr GLuint kSpheresBinding = 0;
constexpr GLsizei kCorners = 4;
}  // namespace

void SpherePass::draw(std::span<const SphereInstance> spheres, float halo_width, float hidden_opacity,
                      GlyphPart part) {
  if (spheres.empty()) return;
  if (!program_) {
    program_ = compile_program("glyph/sphere.vert", "glyph/sphere.frag");
    no_vertices_ = make_vertex_array();
  }
  const GlBuffer instances = make_buffer(spheres);
  glUseProgram(program_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kSpheresBinding, instances.name());
  glBindVertexArray(no_vertices_.name());
  draw_glyph_part(part, hidden_opacity, [&](float opacity) {
    glUniform1f(kHaloUniform, opacity < 1.0F ? 0.0F : halo_width);
    glUniform1f(kOpacityUniform, opacity);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, kCorners, static_cast<GLsizei>(spheres.size()));
  });
}

}  // namespace palpate
