/// What each saving of a frame budget adds to the error of a picture of a volume, on a sparse set of its
/// pixels.
///
/// Less pixels are looked at in the picture itself: it is made coarser and enlarged again, both bilinearly,
///
///   a = rms (E_s S - S),   E_s S the picture S from a share s of its pixels                       (1)
///
/// for a coarser context in what the volume adds to the picture, as opaque things stay sharp then; and less
/// samples by rays that are cast once more, with and without the saving. So no frame has to be drawn. Against
/// pictures that were drawn with savings such errors are right within a factor of two.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/render/budget/quality_errors.h"
#include "common/render/camera.h"
#include "common/render/frame_block.h"
#include "common/render/scene_view.h"
#include "common/render/volume/estimate/image_error.h"
#include "common/render/volume/volume_pass.h"

namespace palpate {

// Rays through a volume for a sparse set of the pixels of a picture that stands still.

/// A picture, and what its volume was drawn over, of one size.
struct StillPicture {
  Image behind, shown;
  FrameBlock block;  ///< of this size
  double resolution =
      1.0;  ///< the frame that the volume was drawn in has so many of its pixels along an edge
  std::uint32_t opaque_depth = 0;  ///< of that frame, as VolumePass::draw() was given it
};

/// RGBA of the pixels of a lattice, rows from the bottom.
[[nodiscard]] std::vector<std::uint8_t> pixels_of(const Image& image, const PixelLattice& lattice);

/// The same pixels with rays over what lies behind as `as` has them (VolumePass::draw_as()). Waits for them.
/// Keeps the framebuffer and viewport; another frame's uniform block is bound to 0 then.
/// @param pass that drew the volume of `picture` last.
[[nodiscard]] std::vector<std::uint8_t> cast_sparse_rays(VolumePass& pass, const VolumeView& as,
                                                         const StillPicture& picture,
                                                         const PixelLattice& lattice);

/// Pixel (x, y), from the top left corner, of a picture from `share` of its pixels along either edge,
/// enlarged. RGB in [0, 255]. @param without what is taken from it before; null: nothing.
[[nodiscard]] std::array<double, 3> coarsened_pixel(const Image& image, const Image* without, double share,
                                                    int x, int y);

/// Which pixels of a lattice show some of a lens, rows from the bottom: their rays meet one before or behind
/// opaque things.
[[nodiscard]] std::vector<bool> lens_pixels(const VolumeView& view, const SceneFrame& frame,
                                            const FrameBlock& block, const PixelLattice& lattice);

class SavingEstimate {
 public:
  /// @param asked the error of the picture.
  SavingEstimate(std::shared_ptr<const StillPicture> picture, const SceneFrame& frame, double asked);

  /// Looks at one more saving. Framebuffer and uniform block as cast_sparse_rays().
  /// @return whether there are more.
  bool add(VolumePass& pass);
  /// @pre add() has returned false.
  [[nodiscard]] const QualityErrors& errors() const noexcept { return errors_; }

 private:
  void look_at_pixels(bool lenses);
  [[nodiscard]] PartError difference(const std::vector<std::uint8_t>& a,
                                     const std::vector<std::uint8_t>& b) const;

  std::shared_ptr<const StillPicture> picture_;
  SceneFrame frame_;
  PixelLattice lattice_;
  std::vector<bool> in_lens_;
  std::vector<std::uint8_t> all_samples_;  ///< rays with none saved
  std::size_t steps_ = 0;
  QualityErrors errors_;
};

}  // namespace palpate
