#include "common/render/volume/cached_volume.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/render/gl/program.h"
#include "common/render/volume/volume_bindings.h"

namespace palpate {

namespace {

constexpr int kTileWidth = 128, kTileHeight = 64;  // two blocks of pixels of software rasterisers
constexpr std::array<float, 4> kNothing{};

}  // namespace

bool CachedVolume::possible(const VolumeView& view) {
  return view.cache_picture && !draws_context_alone(view);
}

CachedVolume::CachedVolume(const VolumeView& view, const FrameBlock& block, std::uint32_t opaque_depth)
    : view_(view),
      block_(block),
      width_(static_cast<int>(block.size.x)),
      height_(static_cast<int>(block.size.y)),
      picture_(make_picture_texture(GL_RGBA16, width_, height_, "kept volume")),
      depth_(make_picture_texture(GL_DEPTH_COMPONENT32F, width_, height_, "depths of the kept volume")),
      framebuffer_(make_framebuffer()),
      no_vertices_(make_vertex_array()) {
  PALPATE_CHECK(opaque_depth != 0);
  glCopyImageSubData(opaque_depth, GL_TEXTURE_2D, 0, 0, 0, 0, depth_.name(), GL_TEXTURE_2D, 0, 0, 0, 0,
                     width_, height_, 1);
  for (int bottom = 0; bottom < height_; bottom += kTileHeight)
    for (int left = 0; left < width_; left += kTileWidth) tiles_.push_back({left, bottom});
  const auto off_middle = [&](const Tile& tile) {
    return std::hypot(2 * tile.left + kTileWidth - width_, 2 * tile.bottom + kTileHeight - height_);
  };
  std::ranges::stable_sort(tiles_, {}, off_middle);
}

void CachedVolume::begin() const {
  glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, picture_.name(), 0);
  glClearNamedFramebufferfv(framebuffer_.name(), GL_COLOR, 0, kNothing.data());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, width_, height_);
}

void CachedVolume::begin_tile() const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, width_, height_);
  const Tile& tile = tiles_[next_];
  glEnable(GL_SCISSOR_TEST);
  glScissor(tile.left, tile.bottom, kTileWidth, kTileHeight);
  glClearBufferfv(GL_COLOR, 0, kNothing.data());
}

void CachedVolume::end_tile() {
  glDisable(GL_SCISSOR_TEST);
  ++next_;
}

bool CachedVolume::fits(const VolumeView& view, const FrameBlock& block) const {
  return block == block_ && same_picture(view, view_);
}

void CachedVolume::show(std::uint32_t opaque_depth) {
  if (!program_) program_ = compile_program("background/background.vert", "volume/cached.frag");
  glUseProgram(program_.name());
  glBindTextureUnit(volume_shader::kOpaqueDepth, opaque_depth);
  glBindTextureUnit(volume_shader::kCachedPicture, picture_.name());
  glBindTextureUnit(volume_shader::kStillDepth, depth_.name());
  glBindVertexArray(no_vertices_.name());
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_BLEND);
}

std::uint64_t CachedVolume::bytes() const noexcept {
  constexpr std::uint64_t kPixelBytes = 8 + 4;
  return kPixelBytes * static_cast<std::uint64_t>(width_) * static_cast<std::uint64_t>(height_);
}

}  // namespace palpate
