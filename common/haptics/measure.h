/// Measures of the data at a point of the workspace, by which haptic transfer functions choose stiffness and
/// drag (Ikits 2006, sec. 6.2 and 6.5).
///
/// All of them are continuous wherever the values of the field are, since a stiffness that jumped from cell
/// to cell would be felt as noise; gradients are differences for that reason (stencil.h).
#pragma once

#include <memory>
#include <utility>

#include "common/field/sample.h"
#include "common/field/scalar_field.h"
#include "common/field/vector_field.h"
#include "common/haptics/workspace.h"
#include "common/math/vec.h"

namespace palpate {

class SampledMeasure {
 public:
  SampledMeasure() = default;
  SampledMeasure(const SampledMeasure&) = delete;
  SampledMeasure& operator=(const SampledMeasure&) = delete;
  virtual ~SampledMeasure() = default;

  /// The measure at `x` in the workspace [m], in units of the data. Remembers the cell. @rt Safe.
  [[nodiscard]] virtual ScalarSample at(const Vec3& x) noexcept = 0;
};

/// |v|.
class SpeedMeasure final : public SampledMeasure {
 public:
  SpeedMeasure(std::shared_ptr<const VectorField> field, const Workspace& workspace)
      : field_(std::move(field)), workspace_(workspace) {}
  [[nodiscard]] ScalarSample at(const Vec3& x) noexcept override;

 private:
  std::shared_ptr<const VectorField> field_;
  Workspace workspace_;
  CellHint hint_;
};

/// s.
class ValueMeasure final : public SampledMeasure {
 public:
  ValueMeasure(std::shared_ptr<const ScalarField> field, const Workspace& workspace)
      : field_(std::move(field)), workspace_(workspace) {}
  [[nodiscard]] ScalarSample at(const Vec3& x) noexcept override;

 private:
  std::shared_ptr<const ScalarField> field_;
  Workspace workspace_;
  CellHint hint_;
};

/// |grad s|, by differences over stencil_spacing().
class GradientMeasure final : public SampledMeasure {
 public:
  GradientMeasure(std::shared_ptr<const ScalarField> field, const Workspace& workspace);
  [[nodiscard]] ScalarSample at(const Vec3& x) noexcept override;

 private:
  std::shared_ptr<const ScalarField> field_;
  Workspace workspace_;
  double spacing_;
  CellHint hint_;
};

}  // namespace palpate
