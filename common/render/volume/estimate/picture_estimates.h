/// What is estimated of a picture of a volume while it stands still: its error, and what savings would add to
/// it.
#pragma once

#include <memory>
#include <optional>

#include "common/render/budget/quality_errors.h"
#include "common/render/camera.h"
#include "common/render/volume/estimate/image_error.h"
#include "common/render/volume/estimate/saving_estimate.h"
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

class PictureEstimates {
 public:
  /// From now on of this picture, of which nothing is known yet.
  void keep(StillPicture picture, const SceneFrame& frame);
  void forget();
  [[nodiscard]] bool kept() const noexcept { return error_.has_value(); }

  /// As ErrorEstimate::add(). @pre kept(); `pass` drew the picture's volume last, all of whose bricks are
  /// there.
  bool add_to_error(VolumePass& pass);
  /// Nothing before some pixels were looked at.
  [[nodiscard]] std::optional<ImageError> error() const;
  /// As SavingEstimate::add(), of the error that is known by then; false where all savings were looked at.
  /// @pre as add_to_error().
  bool add_saving(VolumePass& pass);
  /// Nothing before all of them were looked at.
  [[nodiscard]] std::optional<QualityErrors> quality_errors() const;

 private:
  std::shared_ptr<const StillPicture> picture_;
  SceneFrame frame_;
  std::optional<ErrorEstimate> error_;
  std::optional<SavingEstimate> savings_;
  bool savings_known_ = false;
};

}  // namespace palpate
