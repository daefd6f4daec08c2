/// Rays through a volume for a sparse set of the pixels of a picture that stands still.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/render/camera.h"
#include "common/render/frame_block.h"
#include "common/render/scene_view.h"
#include "common/render/volume/estimate/image_error.h"
#include "common/render/volume/volume_pass.h"

namespace palpate {

/// What lies behind a volume, with all pixels of its picture.
struct BehindSharp {
  Image behind;
  std::uint32_t opaque_depth = 0;
};

/// A picture, and what its volume was drawn over, of one size.
struct StillPicture {
  Image behind, shown;
  FrameBlock block;  ///< of this size
  double resolution =
      1.0;  ///< the frame that the volume was drawn in has so many of its pixels along an edge
  std::uint32_t opaque_depth = 0;    ///< of that frame, as VolumePass::draw() was given it
  std::optional<BehindSharp> sharp;  ///< where that frame has fewer pixels
};

/// RGBA of the pixels of a lattice, rows from the bottom.
[[nodiscard]] std::vector<std::uint8_t> pixels_of(const Image& image, const PixelLattice& lattice);

/// The same pixels with rays over what lies behind, sharp, as `as` has them (VolumePass::draw_as()). Waits for them.
/// Keeps the framebuffer and viewport; another frame's uniform block is bound to 0 then.
/// @param pass that drew the volume of `picture` last.
[[nodiscard]] std::vector<std::uint8_t> cast_sparse_rays(VolumePass& pass, const VolumeView& as,
                                                         const StillPicture& picture,
                                                         const PixelLattice& lattice);

/// Rays through the voxels that a picture asked for and whose memory did not hold them. A few rays at a time
/// look up few bricks: those of a box of pixels fit where those of the picture do not. Takes half of the
/// picture's memory beside it.
class FinestRays {
 public:
  /// Boxes that make up the lattice, each of which is likely to fit.
  [[nodiscard]] static std::vector<LatticeBox> boxes(const VolumeView& asked, const PixelLattice& lattice);

  /// As cast_sparse_rays(), of converged_view() of what `pass` was asked for, in the pixels of `box`; in others
  /// what lies behind.
  /// @return nothing where the bricks of the box do not fit.
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> cast(const VolumePass& pass,
                                                              const StillPicture& picture,
                                                              const SceneFrame& frame,
                                                              const PixelLattice& lattice,
                                                              const LatticeBox& box);

 private:
  VolumePass finest_;
};

}  // namespace palpate
