/// Rays through a volume for a sparse set of the pixels of a picture that stands still.
#pragma once

#include <cstdint>
#include <vector>

#include "common/render/frame_block.h"
#include "common/render/scene_view.h"
#include "common/render/volume/estimate/image_error.h"
#include "common/render/volume/volume_pass.h"

namespace palpate {

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

}  // namespace palpate
