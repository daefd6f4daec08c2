/// What is estimated of a picture of a volume while it stands still: its error, and what savings would add to
/// it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/render/budget/quality_errors.h"
#include "common/render/camera.h"
#include "common/render/volume/estimate/image_error.h"
#include "common/render/volume/estimate/saving_estimate.h"
#include "common/render/volume/estimate/sparse_rays.h"
#include "common/render/volume/volume_pass.h"

namespace palpate {

class ErrorEstimate {
 public:
  explicit ErrorEstimate(std::shared_ptr<const StillPicture> picture);

  /// Looks at the pixels of one more round, as cast_sparse_rays(); where the picture is of coarser voxels than
  /// it asked for, at those of one box of the round, as FinestRays.
  /// @return whether more are worth it: the error is not known to a tenth.
  bool add(VolumePass& pass, FinestRays& finest, const SceneFrame& frame);

  [[nodiscard]] ImageError error() const noexcept;

 private:
  std::shared_ptr<const StillPicture> picture_;
  void add_pixels(const std::vector<std::uint8_t>& converged, const PixelLattice& lattice,
                  const LatticeBox& box);
  void add_box(VolumePass& pass, FinestRays& finest, const SceneFrame& frame, const PixelLattice& lattice);

  int rounds_ = 0;
  std::vector<LatticeBox> boxes_;  // of this round, not looked at yet
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
  bool add_saving(VolumePass& pass, const OpaquePart& opaque_part);
  /// Nothing before all of them were looked at.
  [[nodiscard]] std::optional<QualityErrors> quality_errors() const;

 private:
  std::shared_ptr<const StillPicture> picture_;
  SceneFrame frame_;
  std::optional<ErrorEstimate> error_;
  std::unique_ptr<FinestRays> finest_;  // kept: what it knows of the volume takes long to find
  std::optional<SavingEstimate> savings_;
  bool savings_known_ = false;
};

}  // namespace palpate
