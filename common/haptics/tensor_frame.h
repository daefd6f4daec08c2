/// What a diffusion tensor says to a linear constraint: its eigenframe, and measures of its anisotropy.
#pragma once

#include <cmath>
#include <memory>
#include <utility>

#include "common/field/tensor/diffusion_measures.h"
#include "common/field/tensor/tensor_field.h"
#include "common/haptics/measure.h"
#include "common/haptics/reference_frame.h"
#include "common/haptics/workspace.h"

namespace palpate {

/// Tensors in the workspace, taken apart. The measures do not depend on how much diffuses, and so jump where
/// that goes to zero, at the border of a mask: here anisotropy fades to isotropy over the last quarter of the
/// typical trace. Frame and measures ask for the same place one after the other,
/// which is then worked out once. One thread.
class TensorReader {
 public:
  struct Reading {
    Mat3 axes{1.0};    ///< e_1 to e_3, by falling eigenvalues; their signs have no meaning
    Anisotropy parts;  ///< faded
    SampleStatus status = SampleStatus::kOutside;
  };

  static constexpr double kFullPart = 0.25;  ///< of TensorField::typical_trace()

  TensorReader(std::shared_ptr<const TensorField> field, const Workspace& workspace);
  /// @param x [m]. @rt Safe.
  [[nodiscard]] const Reading& at(const Vec3& x) noexcept;

 private:
  std::shared_ptr<const TensorField> field_;
  Workspace workspace_;
  double full_trace_;  ///< from which on measures are as they are
  CellHint hint_;
  Vec3 place_{NAN};
  Reading reading_;
};

/// e_1 to e_3 of the tensor, their signs as those of the step before. Always certain: thresholds make up for
/// axes that are not.
class TensorFrame final : public ReferenceFrame {
 public:
  explicit TensorFrame(std::shared_ptr<TensorReader> tensors) : tensors_(std::move(tensors)) {}
  [[nodiscard]] FrameSample at(const Vec3& x, const Mat3& last) noexcept override;

 private:
  std::shared_ptr<TensorReader> tensors_;
};

/// A sum of the barycentric measures of the tensor (diffusion_measures.h), faded as above, in [0, 1].
class AnisotropyMeasure final : public SampledMeasure {
 public:
  enum class Sum : unsigned char {
    kLinear,        ///< c_l
    kLinearPlanar,  ///< c_l + c_p
    kNotPlanar,     ///< 1 - c_p = c_l + c_s
    kSpherical      ///< 1 - c_l - c_p = c_s
  };
  AnisotropyMeasure(std::shared_ptr<TensorReader> tensors, Sum sum)
      : tensors_(std::move(tensors)), sum_(sum) {}
  [[nodiscard]] ScalarSample at(const Vec3& x) noexcept override;

 private:
  std::shared_ptr<TensorReader> tensors_;
  Sum sum_;
};

}  // namespace palpate
