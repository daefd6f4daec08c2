/// Owners of OpenGL objects. All calls need the context current in which the object was made.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace palpate {

/// Moves an object's name (0: none) and deletes it with `Delete`.
template <void (*Delete)(std::uint32_t) noexcept>
class GlObject {
 public:
  GlObject() = default;
  explicit GlObject(std::uint32_t name) noexcept : name_(name) {}
  GlObject(GlObject&& other) noexcept : name_(std::exchange(other.name_, 0U)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    if (this != &other) {
      reset();
      name_ = std::exchange(other.name_, 0U);
    }
    return *this;
  }
  ~GlObject() { reset(); }

  [[nodiscard]] std::uint32_t name() const noexcept { return name_; }
  [[nodiscard]] explicit operator bool() const noexcept { return name_ != 0U; }
  void reset() noexcept {
    if (name_ != 0U) Delete(std::exchange(name_, 0U));
  }

 private:
  std::uint32_t name_ = 0;
};

namespace detail {
void delete_buffer(std::uint32_t name) noexcept;
void delete_texture(std::uint32_t name) noexcept;
void delete_vertex_array(std::uint32_t name) noexcept;
void delete_framebuffer(std::uint32_t name) noexcept;
void delete_renderbuffer(std::uint32_t name) noexcept;
void delete_program(std::uint32_t name) noexcept;
void delete_shader(std::uint32_t name) noexcept;
void delete_query(std::uint32_t name) noexcept;
}  // namespace detail

using GlBuffer = GlObject<detail::delete_buffer>;
using GlTexture = GlObject<detail::delete_texture>;
using GlVertexArray = GlObject<detail::delete_vertex_array>;
using GlFramebuffer = GlObject<detail::delete_framebuffer>;
using GlRenderbuffer = GlObject<detail::delete_renderbuffer>;
using GlProgram = GlObject<detail::delete_program>;
using GlShader = GlObject<detail::delete_shader>;
using GlQuery = GlObject<detail::delete_query>;

[[nodiscard]] GlVertexArray make_vertex_array();

/// Attribute `location` of a vertex: `components` floats that stand `offset` bytes into what is bound at `binding`.
void describe_attribute(std::uint32_t vertex_array, std::uint32_t location, int components,
                        std::size_t offset, std::uint32_t binding = 0);

/// A buffer with a copy of `bytes`; it may be empty.
[[nodiscard]] GlBuffer make_buffer(std::span<const std::byte> bytes);

template <class T>
[[nodiscard]] GlBuffer make_buffer(std::span<const T> values) {
  return make_buffer(std::as_bytes(values));
}

}  // namespace palpate
