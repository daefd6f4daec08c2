/// What each saving of a frame budget adds to the error of a picture of a volume, on a sparse set of its
/// pixels.
///
/// Less pixels are looked at in the picture itself: it is made coarser and enlarged again, both bilinearly,
///
///   a = rms (E_s S - S),   E_s S the picture S from a share s of its pixels                       (1)
///
/// for a coarser context in what the volume adds to the picture, as opaque things stay sharp then. Of a coarser picture
/// opaque things are drawn with so many pixels, as lines are no thinner than one: O_s; where the volume hides them, too.
///
///   a = rms (O_s + E_s (S - O_1) - S)                                                              (2)
///
/// Less samples are looked at by rays that are cast once more, with and without the saving. So no volume has to be drawn.
/// Against pictures that were drawn with savings such errors are right within a factor of two.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "common/render/budget/quality_errors.h"
#include "common/render/camera.h"
#include "common/render/volume/estimate/image_error.h"
#include "common/render/volume/estimate/sparse_rays.h"
#include "common/render/volume/volume_pass.h"

namespace palpate {

/// Pixel (x, y), from the top left corner, of a picture from `share` of its pixels along either edge,
/// enlarged. RGB in [0, 255]. @param without what is taken from it before; null: nothing.
[[nodiscard]] std::array<double, 3> coarsened_pixel(const Image& image, const Image* without, double share,
                                                    int x, int y);

/// Which pixels of a lattice show some of a lens, rows from the bottom: their rays meet one before or behind
/// opaque things.
[[nodiscard]] std::vector<bool> lens_pixels(const VolumeView& view, const SceneFrame& frame,
                                            const FrameBlock& block, const PixelLattice& lattice);

/// O_s of (2), enlarged to the size of the picture. Framebuffer and viewport stay.
using OpaquePart = std::function<Image(const Image& picture, double share)>;

class SavingEstimate {
 public:
  /// @param asked the error of the picture.
  SavingEstimate(std::shared_ptr<const StillPicture> picture, const SceneFrame& frame, double asked);

  /// Looks at one more saving. Framebuffer and uniform block as cast_sparse_rays().
  /// @return whether there are more.
  bool add(VolumePass& pass, const OpaquePart& opaque_part);
  /// @pre add() has returned false.
  [[nodiscard]] const QualityErrors& errors() const noexcept { return errors_; }

 private:
  void look_at_context();
  void look_at_resolution(std::size_t k, const OpaquePart& opaque_part);
  /// Of what `change(x, y)` adds to pixels.
  template <typename Change>
  [[nodiscard]] PartError error_of(const Change& change) const;
  [[nodiscard]] PartError difference(const std::vector<std::uint8_t>& a,
                                     const std::vector<std::uint8_t>& b) const;

  std::shared_ptr<const StillPicture> picture_;
  SceneFrame frame_;
  PixelLattice lattice_;
  std::vector<bool> in_lens_;
  std::vector<std::uint8_t> all_samples_;  ///< rays with none saved
  Image opaque_;                           ///< O_1
  std::size_t steps_ = 0;
  QualityErrors errors_;
};

}  // namespace palpate
