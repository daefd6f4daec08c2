#include "common/render/gl/object.h"

#include <epoxy/gl.h>

namespace palpate {
namespace detail {
void delete_buffer(std::uint32_t name) noexcept { glDeleteBuffers(1, &name); }
void delete_texture(std::uint32_t name) noexcept { glDeleteTextures(1, &name); }
void delete_vertex_array(std::uint32_t name) noexcept { glDeleteVertexArrays(1, &name); }
void delete_framebuffer(std::uint32_t name) noexcept { glDeleteFramebuffers(1, &name); }
void delete_renderbuffer(std::uint32_t name) noexcept { glDeleteRenderbuffers(1, &name); }
void delete_program(std::uint32_t name) noexcept { glDeleteProgram(name); }
void delete_shader(std::uint32_t name) noexcept { glDeleteShader(name); }
void delete_query(std::uint32_t name) noexcept { glDeleteQueries(1, &name); }
}  // namespace detail

GlVertexArray make_vertex_array() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return GlVertexArray(name);
}

void describe_attribute(std::uint32_t vertex_array, std::uint32_t location, int components,
                        std::size_t offset, std::uint32_t binding) {
  glEnableVertexArrayAttrib(vertex_array, location);
  glVertexArrayAttribFormat(vertex_array, location, components, GL_FLOAT, GL_FALSE,
                            static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(vertex_array, location, binding);
}

GlBuffer make_buffer(std::span<const std::byte> bytes) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  GlBuffer buffer(name);
  // A buffer without storage cannot be bound to a shader: one byte stands for an empty one.
  const std::byte nothing{0};
  const bool empty = bytes.empty();
  glNamedBufferStorage(name, empty ? 1 : static_cast<GLsizeiptr>(bytes.size()),
                       empty ? &nothing : bytes.data(), GL_DYNAMIC_STORAGE_BIT);
  return buffer;
}

}  // namespace palpate
