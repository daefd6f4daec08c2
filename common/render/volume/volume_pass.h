/// Draws a volume by casting one ray a pixel (shaders/volume/).
///
/// Symbols.  t length along a ray in the scene frame, from the eye (perspective) or from the plane through it
/// (orthographic); d distance of samples.
///
/// Samples stand at t = n d for whole n, on one lattice a ray; the box of the volume, borders of lenses and
/// opaque things only split the intervals between them. A whole interval takes colour and opacity from the
/// layer of the preintegrated table for length d; a part of one from the two layers about its length (Ikits
/// 2006, sec. 5.4). Rays choose d from the lengths of the table so that they sample a voxel as often as asked
/// for, whatever the spacing of voxels along them; never more than kStepRatio times the shortest step of all.
/// Around lenses the context may be drawn by itself, smaller and from coarser voxels (context_picture.h).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/render/camera.h"
#include "common/render/frame_block.h"
#include "common/render/picture_cache.h"
#include "common/render/volume/volume_view.h"

namespace palpate {

class LineLayers;

class VolumePass {
 public:
  VolumePass();
  ~VolumePass();
  VolumePass(const VolumePass&) = delete;
  VolumePass& operator=(const VolumePass&) = delete;

  /// Uploads what `asked` changes: voxels when the image is another one, tables when transfer functions or
  /// lengths are.
  /// @pre asked.image is not null; samples a voxel are positive and finite; at most kMostLenses lenses and
  /// kMostTransfers transfer functions; at least two table entries, and lengths a multiple of kLengthGroup.
  /// @param block of the picture that draw() is to make: a volume in bricks holds those that it looks up.
  /// @throws Error as VolumeTextures::update().
  void update(const VolumeView& asked, const SceneFrame& frame, const FrameBlock& block);
  /// Has rays show transparent lines in their place, too, from the next update() on (null: none any more).
  /// Nothing is kept of slabs then, and the context of lenses is not drawn alone: what is saved so would have
  /// to be divided at each line.
  /// @param layers of each pixel; their content may change with each picture. Outlives the pass.
  /// @param same whether they are as in the last picture; else no picture is kept.
  void show_layers(const LineLayers* layers, bool same);
  /// How many bricks there are for the picture: where some of them lack, the same one drawn again has more.
  [[nodiscard]] BrickShare bricks() const noexcept;

  /// Draws over the framebuffer that is bound, with the one shader that this needs, behind none of what it
  /// holds but in front of it as far as the depths say: with associated colours, without writing depth. Needs
  /// the frame's uniform block bound to 0.
  /// @param opaque_depth a texture with the depths of opaque things, one sample for each pixel of the frame
  /// block, or 0 where there are none (RenderTarget::copy_depth).
  /// While one plane that cuts moves and all else stands still, what does not change is kept (slab_cache.h);
  /// any other change throws it away. While nothing of the volume changes, its picture may be
  /// (VolumeView::cache_picture).
  /// @pre update().
  /// @param block the frame's.
  /// @param stop where set, asked every few hundredths of a second; where it says so, nothing is kept of the
  /// picture.
  /// @throws DrawingStopped (tile_pass.h) then.
  void draw(std::uint32_t opaque_depth, const FrameBlock& block, const std::function<bool()>& stop = {});

  /// Draws the values on the planes of the view, opaque and with depth, where shows_planes(): before draw(),
  /// so that they end its rays. Needs the frame's uniform block bound to 0.
  /// @pre update().
  /// @param block the frame's.
  void draw_planes(const FrameBlock& block);

  /// The volume of the last draw(), with what was drawn in place of its images. @pre draw().
  [[nodiscard]] const VolumeView& drawn_view() const;
  /// What the last update() asked for. Its images are drawn_view()'s where has_asked_voxels(). @pre update().
  [[nodiscard]] const VolumeView& asked_view() const noexcept;
  /// Whether the voxels that were asked for are there, of the context and of the fields that lenses show; else
  /// coarser ones, as they do not fit their storage. @pre update().
  [[nodiscard]] bool has_asked_voxels() const;
  [[nodiscard]] const LineLayers* layers() const noexcept;  ///< of show_layers()
  /// Draws rays through the volume of the last update(), with other samples and tables, over the framebuffer
  /// that is bound: for a sparse set of its pixels (sparse_rays.h), or to refine it. Needs the block of that frame
  /// bound to 0.
  /// @param as what is drawn but for samples, tables, what is left out and what is kept; a context that is
  /// drawn alone, and fewer samples far from the viewer, it has not.
  /// @param opaque_depth as draw() was given it. @param step its pixels along either edge, to one of these.
  /// @pre update(), and bricks().complete().
  void draw_as(const VolumeView& as, std::uint32_t opaque_depth, float step);

  /// Draws nothing, but refines one more part of the picture of the last draw(), to what finer_view() gives,
  /// for the next ones of the same volume to show: while nobody waits. Needs the frame's uniform block bound
  /// to 0.
  /// @param doublings > 0; other ones than before begin with the first part again.
  /// @return whether parts are left; never where there is no picture of depths, or bricks lack.
  bool refine(int doublings);

  /// Draws nothing, but keeps one more picture of a slab for when the cut of that number moves, and has what
  /// draw() then needs compiled: for while nobody waits. Over the framebuffer of the last draw(), with the
  /// frame's uniform block bound to 0.
  /// @return whether more are worth keeping; never where no slabs are kept of such a view, or nothing was
  /// drawn.
  bool prepare_slabs(std::size_t cut);
  /// Whether the last draw() made what that cache holds, which takes longer than the pictures that follow: its
  /// picture of the volume, or pictures of slabs. Never of kStillPart.
  [[nodiscard]] bool made(PictureCache cache) const noexcept;
  /// Gives back what that cache holds, which the next draw() may make anew: opaque things have come to stay, or
  /// a plane that moved rests.
  void forget(PictureCache cache) noexcept;

  /// The coarser volume that is drawn in place of the view's; nothing where that is drawn.
  [[nodiscard]] std::optional<CoarserVoxels> coarser_voxels() const noexcept;

  /// What was made for the last view, for `--explain`.
  struct Cost {
    int programs = 0;               ///< compiled by this pass so far
    std::uint64_t voxel_bytes = 0;  ///< textures on the GPU
    std::uint64_t table_bytes = 0;
    std::uint64_t brick_bytes = 0;
    std::uint64_t slab_bytes = 0;     ///< kept of a plane that moves
    std::uint64_t cached_bytes = 0;   ///< the cached picture of a volume that stands still
    std::uint64_t again_bytes = 0;    ///< tables of draw_as()
    std::uint64_t context_bytes = 0;  ///< coarser voxels, tables and pictures of the context, drawn alone
    double table_ms = 0.0;            ///< of the last preintegration
    int tables_made = 0;              ///< then
    double segments_made = 0.0;       ///< then, of the last of these, the share that was made anew
    std::string tables_by;            ///< TableChoice::text(): who filled them, and why
    double empty_share = 0.0;         ///< of the bricks, for the context
  };
  [[nodiscard]] Cost cost() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace palpate
