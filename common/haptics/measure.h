/// Measures of the data at a point of the workspace, by which haptic transfer functions choose stiffness and
/// drag (Ikits 2006, sec. 6.2 and 6.5).
///
/// All of them are continuous wherever the values of the field are, since a stiffness that jumped from cell
/// to cell would be felt as noise; gradients are differences for that reason (measure.h).
#pragma once

#include <memory>
#include <utility>

#include "common/field/sample.h"
#include "common/field/scalar_field.h"
#include "common/field/vector_field.h"
#include "common/haptics/workspace.h"
#include "common/math/jet.h"
#include "common/math/vec.h"

namespace palpate {

// Derivatives of scalar fields by central differences of their values, data units.
//
// The derivatives of an interpolant leap from cell to cell (on tetrahedra its gradient is constant in each,
// and its Hessian zero). Those of its differences over a fixed spacing h do not: they are as continuous as
// the values, and of second order in h, which is about the distance of the data's points.

/// h: the edge of a cube that holds one point of the grid on average; 2^-10 of the diagonal for a formula.
[[nodiscard]] double stencil_spacing(const ScalarField& field) noexcept;

/// The gradient, 6 samples; their status where one of them is not good, and zero then. @rt Safe.
[[nodiscard]] VectorSample difference_gradient(const ScalarField& field, const Vec3& x_data, double spacing,
                                               CellHint& hint) noexcept;

/// Value, gradient and Hessian, 19 samples. @return as difference_gradient(); `jet` is zero then. @rt Safe.
[[nodiscard]] SampleStatus difference_jet(const ScalarField& field, const Vec3& x_data, double spacing,
                                          CellHint& hint, Jet3& jet) noexcept;

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
  [[nodiscard]] ScalarSample at(const Vec3& x) noexcept override {
    const VectorSample sample = field_->sample(workspace_.data_from_workspace(x), hint_);
    return {glm::length(sample.value), sample.status};
  }

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
  [[nodiscard]] ScalarSample at(const Vec3& x) noexcept override {
    return field_->sample(workspace_.data_from_workspace(x), hint_);
  }

 private:
  std::shared_ptr<const ScalarField> field_;
  Workspace workspace_;
  CellHint hint_;
};

/// |grad s|, by differences over stencil_spacing().
class GradientMeasure final : public SampledMeasure {
 public:
  GradientMeasure(std::shared_ptr<const ScalarField> field, const Workspace& workspace)
      : field_(std::move(field)), workspace_(workspace), spacing_(stencil_spacing(*field_)) {}
  [[nodiscard]] ScalarSample at(const Vec3& x) noexcept override {
    const VectorSample gradient =
        difference_gradient(*field_, workspace_.data_from_workspace(x), spacing_, hint_);
    return {glm::length(gradient.value), gradient.status};
  }

 private:
  std::shared_ptr<const ScalarField> field_;
  Workspace workspace_;
  double spacing_;
  CellHint hint_;
};

}  // namespace palpate
