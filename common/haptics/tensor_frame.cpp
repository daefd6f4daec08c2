#include "common/haptics/tensor_frame.h"

#include <cmath>

#include "common/base/error.h"
#include "common/field/tensor/diffusion_measures.h"
#include "common/field/tensor/eigenframe.h"
#include "common/math/symmetric3.h"

namespace palpate {

FrameSample TensorFrame::at(const Vec3& x, const Mat3& last) noexcept {
  const TensorSample sample = field_->sample(workspace_.data_from_workspace(x), hint_);
  if (sample.status != SampleStatus::kOk) return {.axes = last, .status = sample.status};
  return {.axes = carried_frame(symmetric_eigen(sample.value).vectors, last)};
}

ScalarSample AnisotropyMeasure::at(const Vec3& x) noexcept {
  const TensorSample sample = field_->sample(workspace_.data_from_workspace(x), hint_);
  if (sample.status != SampleStatus::kOk) return {.status = sample.status};
  const Anisotropy parts = anisotropy(symmetric_eigenvalues(sample.value));
  double sum = parts.spherical;
  switch (sum_) {
    case Sum::kLinear:
      sum = parts.linear;
      break;
    case Sum::kLinearPlanar:
      sum = parts.linear + parts.planar;
      break;
    case Sum::kNotPlanar:
      sum = parts.linear + parts.spherical;
      break;
    case Sum::kSpherical:
      break;
  }
  return {.value = sum, .status = SampleStatus::kOk};
}

std::unique_ptr<LinearConstraint> anisotropy_drag(const std::shared_ptr<const TensorField>& field,
                                                  const Workspace& workspace, IsotropicPlaces isotropic) {
  using Sum = AnisotropyMeasure::Sum;
  const auto measure = [&](Sum sum) { return std::make_shared<AnisotropyMeasure>(field, workspace, sum); };
  std::array<AxisMeasures, 3> measures;
  if (isotropic == IsotropicPlaces::kFree) {
    measures[1].tau = measure(Sum::kLinear);
    measures[2].tau = measure(Sum::kLinearPlanar);
  } else {
    measures[0].tau = measure(Sum::kSpherical);
    measures[1].tau = measure(Sum::kNotPlanar);
  }
  return std::make_unique<LinearConstraint>(std::make_unique<TensorFrame>(field, workspace),
                                            std::move(measures));
}

LinearSettings anisotropy_settings(const HapticTransferFunction& tau, IsotropicPlaces isotropic) {
  if (!(tau.lowest() >= 0.0) || !std::isfinite(tau.highest())) {
    throw usage_error("a drag threshold that is below zero or not finite");
  }
  if (isotropic == IsotropicPlaces::kFree && tau(0.0) != 0.0) {
    throw usage_error(
        "a drag threshold that is not 0 where nothing is anisotropic: the hold would depend on axes that "
        "are not defined there; let it begin with 0:0");
  }
  LinearSettings settings;
  for (LinearAxis& axis : settings.axes) axis = {.rule = AxisRule::kDrag, .tau = tau};
  if (isotropic == IsotropicPlaces::kFree) {
    settings.axes[0].rule = AxisRule::kFree;
  } else {
    settings.axes[2].tau = tau(1.0);
  }
  return settings;
}

}  // namespace palpate
