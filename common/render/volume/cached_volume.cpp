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

}  // namespace

bool CachedVolume::possible(const VolumeView& view) {
  return view.cache_picture && !draws_context_alone(view);
}

CachedVolume::CachedVolume(const VolumeView& view, const FrameBlock& block, std::uint32_t opaque_depth)
    : VolumeCache(view, block, opaque_depth, "cached volume"),
      picture_(make_picture()),
      no_vertices_(make_vertex_array()) {
  PALPATE_CHECK(opaque_depth != 0);
  for (int bottom = 0; bottom < height(); bottom += kTileHeight)
    for (int left = 0; left < width(); left += kTileWidth) tiles_.push_back({left, bottom});
  const auto off_middle = [&](const Tile& tile) {
    return std::hypot(2 * tile.left + kTileWidth - width(), 2 * tile.bottom + kTileHeight - height());
  };
  std::ranges::stable_sort(tiles_, {}, off_middle);
}

void CachedVolume::begin_tile() const {
  constexpr std::array<float, 4> kNothing{};
  bind(picture_);
  const Tile& tile = tiles_[next_];
  glEnable(GL_SCISSOR_TEST);
  glScissor(tile.left, tile.bottom, kTileWidth, kTileHeight);
  glClearBufferfv(GL_COLOR, 0, kNothing.data());
}

void CachedVolume::end_tile() {
  glDisable(GL_SCISSOR_TEST);
  ++next_;
}

void CachedVolume::show(std::uint32_t opaque_depth) {
  if (!program_) program_ = compile_program("background/background.vert", "volume/cached.frag");
  glUseProgram(program_.name());
  glBindTextureUnit(volume_shader::kOpaqueDepth, opaque_depth);
  glBindTextureUnit(volume_shader::kCachedPicture, picture_.name());
  glBindTextureUnit(volume_shader::kStillDepth, depth());
  glBindVertexArray(no_vertices_.name());
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_BLEND);
}

}  // namespace palpate
