#include "common/render/glyph/sphere_pass.h"

#include <epoxy/gl.h>

#include "common/render/gl/program.h"

namespace palpate {
namespace {
// Of shaders/glyph/sphere.vert.
constexpr GLint kHaloWidth = 0;
constexpr GLuint kSpheresBinding = 0;
constexpr GLsizei kCorners = 4;
}  // namespace

void SpherePass::draw(std::span<const SphereInstance> spheres, float halo_width) {
  if (spheres.empty()) return;
  if (!program_) {
    program_ = compile_program("glyph/sphere.vert", "glyph/sphere.frag");
    no_vertices_ = make_vertex_array();
  }
  const GlBuffer instances = make_buffer(spheres);
  glUseProgram(program_.name());
  glUniform1f(kHaloWidth, halo_width);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kSpheresBinding, instances.name());
  glBindVertexArray(no_vertices_.name());
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, kCorners, static_cast<GLsizei>(spheres.size()));
}

}  // namespace palpate
