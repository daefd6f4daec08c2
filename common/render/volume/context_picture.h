/// What lies outside lenses as a picture of its own, smaller and from coarser voxels than what lies inside
/// (Ikits 2006, sec. 5.7.3).
///
/// A ray has context before its first lens and behind its last one. Both are cast with fewer pixels into two
/// pictures with associated colours, F and B; each ray of the whole picture then casts what lies between,
/// whose colour is L, and composes
///   F + (1 - A_F) (L + (1 - A_L) B)                                                              (1)
/// F and B are enlarged bilinearly between those of the four pixels around that show the same: rays that meet
/// a lens where this one does, or none where it meets none, and end at an opaque thing as far away. So
/// neither lenses nor opaque things fray at their borders. Where there is no such pixel, the ray is cast as a
/// whole. Tiles of 8 x 8 pixels that see no lens and no border of an opaque thing are F enlarged, and cast no
/// rays.
#pragma once

#include <cstdint>
#include <memory>

#include "common/render/frame_block.h"
#include "common/render/gl/object.h"
#include "common/render/volume/shape_block.h"
#include "common/render/volume/volume_textures.h"
#include "common/render/volume/volume_view.h"

namespace palpate {

/// Of the memory for voxels, one part is for a context from coarser ones.
inline constexpr std::uint64_t kContextShare = 4;

class ContextPicture {
 public:
  /// @param whole what was made for the whole of `view`.
  /// Its coarser voxels take one of kContextShare parts of the memory that the view has for voxels.
  /// @pre draws_context_alone(view), and as for VolumePass::update().
  void update(const VolumeView& view, const SceneFrame& frame, const VolumeTextures& whole);

  /// Draws F and B, and tells tiles apart. Keeps framebuffer, viewport and the frame's uniform block.
  /// @param opaque_depth, block of the whole picture, as for VolumePass::draw(). @pre update().
  void draw(std::uint32_t opaque_depth, const FrameBlock& block);

  /// Draws the tiles of the whole picture that are F enlarged, over the framebuffer that is bound.
  void show();
  /// Gives F, B and the voxels that they are of to the program in use (shaders/volume/enlarge.glsl,
  /// blend.glsl), and where it draws (shaders/volume/context_tiles.vert): in the other ones of grid().
  void bind() const;
  [[nodiscard]] const TileGrid& grid() const noexcept { return grid_; }  ///< of the whole picture

  struct Cost {
    int programs = 0;         ///< compiled so far, but for that of tiles, which the whole has, too
    std::uint64_t bytes = 0;  ///< on the GPU
  };
  [[nodiscard]] Cost cost() const noexcept;

 private:
  void resize(int width, int height);
  void draw_context(const FrameBlock& smaller);
  [[nodiscard]] float farthest(const Vec3& eye) const;
  void draw_kinds(const FrameBlock& block);
  void use_blocks() const;
  void bind_pictures(std::uint32_t wanted) const;

  VolumeView view_;  ///< of the context alone: from coarser voxels, lenses cut away
  std::shared_ptr<const VolumeImage> fine_;
  bool magnifies_ = false;
  int level_ = 0;  ///< of view_.image, which was made from fine_
  SceneFrame frame_;
  double share_ = 1.0;  ///< of the pixels along either edge
  bool has_opaque_depth_ = false;

  VolumeTextures textures_;
  std::vector<std::string> defines_;  ///< of all but `enlarged_`
  ShapeRoom room_;
  GlProgram unlit_, shaded_, tiles_, enlarged_;
  GlVertexArray no_vertices_;
  GlBuffer volume_block_, shape_block_;
  int width_ = 0, height_ = 0;
  GlTexture front_, back_, kind_;
  GlFramebuffer framebuffer_;
  TileGrid grid_;
  GlTexture tile_kinds_;
  GlFramebuffer tile_framebuffer_;
  float scale_ = 1.0F, left_ = 0.0F, bottom_ = 0.0F;  ///< x here = scale x in the whole picture + left
};

}  // namespace palpate
