#include "common/haptics/measure.h"

#include "common/haptics/stencil.h"

namespace palpate {

ScalarSample SpeedMeasure::at(const Vec3& x) noexcept {
  const VectorSample sample = field_->sample(workspace_.data_from_workspace(x), hint_);
  return {glm::length(sample.value), sample.status};
}

ScalarSample ValueMeasure::at(const Vec3& x) noexcept {
  return field_->sample(workspace_.data_from_workspace(x), hint_);
}

GradientMeasure::GradientMeasure(std::shared_ptr<const ScalarField> field, const Workspace& workspace)
    : field_(std::move(field)), workspace_(workspace), spacing_(stencil_spacing(*field_)) {}

ScalarSample GradientMeasure::at(const Vec3& x) noexcept {
  const VectorSample gradient =
      difference_gradient(*field_, workspace_.data_from_workspace(x), spacing_, hint_);
  return {glm::length(gradient.value), gradient.status};
}

}  // namespace palpate
