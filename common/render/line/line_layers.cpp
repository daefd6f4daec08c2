#include "common/render/line/line_layers.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/render/gl/program.h"

namespace palpate {
namespace {

// Of shaders/line/layers.glsl.
constexpr GLuint kFragments = 3, kHeads = 4;
constexpr std::size_t kFragmentBytes = 16, kCountBytes = 4;

std::size_t most_fragments() {
  constexpr std::size_t kMostBytes = std::size_t{1} << 29U;  // more takes other things' memory
  GLint64 bytes = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &bytes);
  return (std::min(as_size(bytes), kMostBytes) - kCountBytes) / kFragmentBytes;
}

GlBuffer make_room(std::size_t bytes) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  glNamedBufferStorage(name, static_cast<GLsizeiptr>(bytes), nullptr, 0);
  return GlBuffer(name);
}

void clear(const GlBuffer& buffer, std::size_t bytes) {
  glClearNamedBufferSubData(buffer.name(), GL_R32UI, 0, static_cast<GLsizeiptr>(bytes), GL_RED_INTEGER,
                            GL_UNSIGNED_INT, nullptr);
}

}  // namespace

void LineLayers::reserve(std::size_t fragments) {
  if (fragments <= room_) return;
  room_ = std::min(std::bit_ceil(fragments), most_fragments());
  fragments_ = make_room(kCountBytes + kFragmentBytes * room_);
}

bool LineLayers::collect(int width, int height, const std::function<void()>& draw) {
  PALPATE_CHECK(width > 0 && height > 0);
  const std::size_t pixels = as_size(width) * as_size(height);
  if (pixels != pixels_) heads_ = make_room(sizeof(std::uint32_t) * pixels);
  pixels_ = pixels;
  constexpr std::size_t kFirstRoom = std::size_t{1} << 16U;
  reserve(kFirstRoom);
  for (;;) {
    clear(heads_, sizeof(std::uint32_t) * pixels);
    clear(fragments_, kCountBytes);
    bind();
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    draw();
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    std::uint32_t count = 0;
    glGetNamedBufferSubData(fragments_.name(), 0, sizeof count, &count);
    if (count <= room_) break;
    if (room_ == most_fragments()) return false;
    reserve(count);
  }

  if (!sort_) sort_ = compile_compute("line/sort_layers.comp");
  glUseProgram(sort_.name());
  constexpr std::size_t kGroup = 64;  // local_size_x of the shader
  glDispatchCompute(static_cast<GLuint>((pixels + kGroup - 1) / kGroup), 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  return true;
}

void LineLayers::bind() const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kFragments, fragments_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kHeads, heads_.name());
}

}  // namespace palpate
