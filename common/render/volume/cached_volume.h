/// Local rendering (Ikits 2006, sec. 5.1): while camera and volume stand still, the picture of the volume is
/// kept apart from what is opaque, with the depths z_0 at which its rays ended. It is laid over opaque things
/// wherever these are as deep as they were; where one has moved, z != z_0, the ray is cast anew:
///
///   picture = K over opaque where z = z_0,   else the ray up to z over opaque                       (1)
///
/// While nothing moves K is refined tile by tile.
///
/// K has one sample a pixel, as rays do, and 16 bits a component; what is opaque keeps its own samples. So
/// (1) is the picture of a full redraw, but for the rounding of K.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/render/frame_block.h"
#include "common/render/gl/object.h"
#include "common/render/gl/target.h"
#include "common/render/volume/volume_cache.h"
#include "common/render/volume/volume_view.h"

namespace palpate {

class CachedVolume : public VolumeCache {
 public:
  /// Whether (1) holds for such a view. Not where the context of lenses is a smaller picture: its pixels are
  /// told apart by opaque things beside them, moved ones too.
  [[nodiscard]] static bool possible(const VolumeView& view);

  /// Has a picture of `view` made and keeps it.
  /// @param opaque_depth as of VolumePass::draw(), not 0; copied.
  /// @param draw draws the volume over a framebuffer that is bound and clear. Framebuffer and viewport are
  /// kept.
  template <typename Draw>
  CachedVolume(const VolumeView& view, const FrameBlock& block, std::uint32_t opaque_depth, const Draw& draw)
      : CachedVolume(view, block, opaque_depth) {
    const FramebufferGuard before;
    bind(picture_);
    draw();
  }

  /// Whether what is kept is the picture of `view` from there.
  [[nodiscard]] bool fits(const VolumeView& view, const FrameBlock& block) const {
    return same(view, block, true);
  }
  /// Draws one more tile of K anew, from the middle outward, as it is to be seen from now on.
  /// @param fineness > 0; another one than before begins with the first tile again.
  /// @param draw as for the whole picture; over depths z_0. Framebuffer and viewport are kept.
  /// @return whether tiles are left. Needs the scissor test, off before and after.
  template <typename Draw>
  bool refine(int fineness, const Draw& draw) {
    if (fineness != fineness_) next_ = 0;
    fineness_ = fineness;
    if (next_ == tiles_.size()) return false;
    const FramebufferGuard before;
    begin_tile();
    draw();
    end_tile();
    return next_ < tiles_.size();
  }
  /// Whether some of it was refined.
  [[nodiscard]] bool refined() const noexcept { return fineness_ > 0; }

  /// Draws K over the framebuffer that is bound, where z = z_0.
  void show(std::uint32_t opaque_depth);
  [[nodiscard]] std::uint64_t bytes() const noexcept { return VolumeCache::bytes(1); }

 private:
  CachedVolume(const VolumeView& view, const FrameBlock& block, std::uint32_t opaque_depth);
  void begin_tile() const;
  void end_tile();

  struct Tile {
    int left = 0, bottom = 0;
  };
  std::vector<Tile> tiles_;
  int fineness_ = 0;
  std::size_t next_ = 0;  ///< tile to be refined
  GlTexture picture_;
  GlVertexArray no_vertices_;
  GlProgram program_;
};

}  // namespace palpate
