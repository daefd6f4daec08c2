/// Looks at some pixels of a picture again, converged (image_error.h).
#pragma once

#include <cstdint>

#include "common/render/frame_block.h"
#include "common/render/gl/object.h"
#include "common/render/scene_view.h"
#include "common/render/volume/image_error.h"
#include "common/render/volume/volume_pass.h"

namespace palpate {

class ErrorEstimate {
 public:
  /// @param behind what the volume was drawn over, `shown` with the volume: as large as the picture.
  /// @param block of the picture, of which the frame that the volume was drawn in has `resolution` as many
  /// pixels along either edge.
  ErrorEstimate(Image behind, Image shown, const FrameBlock& block, double resolution);

  /// Looks at the pixels of one more round. Keeps the framebuffer and viewport; another frame's uniform block
  /// is bound to 0 then.
  /// @param pass that drew the volume last, over depths `opaque_depth`.
  /// @return whether more are worth it: the error is not known to a tenth.
  bool add(VolumePass& pass, std::uint32_t opaque_depth);

  [[nodiscard]] ImageError error() const noexcept;

 private:
  Image behind_, shown_;
  FrameBlock block_;
  double resolution_;
  int rounds_ = 0;
  double milliseconds_ = 0.0;
  ErrorSum sum_;
};

}  // namespace palpate
