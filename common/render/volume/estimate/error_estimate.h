/// Looks at some pixels of a picture again, converged (image_error.h).
#pragma once

#include <memory>

#include "common/render/volume/estimate/image_error.h"
#include "common/render/volume/estimate/sparse_rays.h"
#include "common/render/volume/volume_pass.h"

namespace palpate {

class ErrorEstimate {
 public:
  explicit ErrorEstimate(std::shared_ptr<const StillPicture> picture);

  /// Looks at the pixels of one more round, as cast_sparse_rays().
  /// @return whether more are worth it: the error is not known to a tenth.
  bool add(VolumePass& pass);

  [[nodiscard]] ImageError error() const noexcept;

 private:
  std::shared_ptr<const StillPicture> picture_;
  int rounds_ = 0;
  double milliseconds_ = 0.0;
  ErrorSum sum_;
};

}  // namespace palpate
