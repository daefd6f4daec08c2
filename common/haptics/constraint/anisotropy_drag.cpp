#include "common/haptics/constraint/anisotropy_drag.h"

#include <array>
#include <utility>

namespace palpate {
namespace {

/// What the thresholds of either construction take; none where the threshold is a constant.
std::array<AxisMeasures, 3> measures_of(const std::shared_ptr<TensorReader>& tensors,
                                        IsotropicPlaces isotropic) {
  using Sum = AnisotropyMeasure::Sum;
  const auto measure = [&](Sum sum) { return std::make_shared<AnisotropyMeasure>(tensors, sum); };
  std::array<AxisMeasures, 3> measures;
  if (isotropic == IsotropicPlaces::kFree) {
    measures[1].tau = measure(Sum::kLinear);
    measures[2].tau = measure(Sum::kLinearPlanar);
  } else {
    measures[0].tau = measure(Sum::kSpherical);
    measures[1].tau = measure(Sum::kNotPlanar);
  }
  return measures;
}

}  // namespace

AnisotropyDrag::AnisotropyDrag(std::shared_ptr<const TensorField> field, const Workspace& workspace,
                               IsotropicPlaces isotropic)
    : AnisotropyDrag(std::make_shared<TensorReader>(std::move(field), workspace), isotropic) {}

AnisotropyDrag::AnisotropyDrag(const std::shared_ptr<TensorReader>& tensors, IsotropicPlaces isotropic)
    : isotropic_(isotropic),
      linear_(std::make_unique<TensorFrame>(tensors), measures_of(tensors, isotropic)) {}

void AnisotropyDrag::apply(const ChainSettings& settings) noexcept {
  const HapticTransferFunction& tau = settings.anisotropy.tau;
  ChainSettings by_axis = settings;
  by_axis.linear = LinearSettings{.fade_distance = settings.linear.fade_distance};
  for (LinearAxis& axis : by_axis.linear.axes) axis = {.rule = AxisRule::kDrag, .tau = tau};
  if (isotropic_ == IsotropicPlaces::kFree) {
    by_axis.linear.axes[0].rule = AxisRule::kFree;
  } else {
    by_axis.linear.axes[2].tau = tau(1.0);
  }
  linear_.apply(by_axis);
}

}  // namespace palpate
