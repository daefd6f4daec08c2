#include "common/haptics/constraint/anisotropy_drag.h"

#include <array>
#include <utility>

#include "common/field/tensor/eigenframe.h"
#include "common/field/tensor/peak_field.h"
#include "common/haptics/fade.h"
#include "common/haptics/motion_rule.h"
#include "common/math/symmetric3.h"

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

TensorReader::TensorReader(std::shared_ptr<const TensorField> field, const Workspace& workspace)
    : field_(std::move(field)), workspace_(workspace), full_trace_(kFullPart * field_->typical_trace()) {}

void TensorReader::go(const Vec3& toward) noexcept {
  if (field_->peaks() == nullptr) return;
  if (toward == toward_) return;
  toward_ = toward;
  place_ = Vec3{NAN};
}

TensorSample TensorReader::sample(const Vec3& x_data) noexcept {
  const PeakField* const peaks = field_->peaks();
  if (peaks == nullptr) return field_->sample(x_data, hint_);
  if (toward_ != Vec3{0.0}) return peaks->sample(x_data, toward_);
  const Vec3 longest = peaks->longest(x_data);
  if (longest == Vec3{0.0}) return {.status = SampleStatus::kBadData};
  return peaks->sample(x_data, glm::normalize(longest));
}

const TensorReader::Reading& TensorReader::at(const Vec3& x) noexcept {
  if (x == place_) return reading_;
  place_ = x;
  const TensorSample sample = this->sample(workspace_.data_from_workspace(x));
  reading_ = {.status = sample.status};
  if (sample.status == SampleStatus::kOk) {
    const SymmetricEigen eigen = symmetric_eigen(sample.value);
    reading_.axes = eigen.vectors;
    reading_.parts = anisotropy(eigen.values);
    const Vec3 positive = glm::max(eigen.values, Vec3{0.0});
    const double diffusing = fade((positive.x + positive.y + positive.z) / full_trace_);
    reading_.parts.linear *= diffusing;
    reading_.parts.planar *= diffusing;
    reading_.parts.spherical = 1.0 - reading_.parts.linear - reading_.parts.planar;
  }
  return reading_;
}

FrameSample TensorFrame::at(const Vec3& x, const Mat3& last) noexcept {
  tensors_->go(begun_ ? last[0] : Vec3{0.0});
  const TensorReader::Reading& reading = tensors_->at(x);
  if (reading.status != SampleStatus::kOk) return {.axes = last, .status = reading.status};
  begun_ = true;
  return {.axes = carried_frame(reading.axes, last)};
}

ScalarSample AnisotropyMeasure::at(const Vec3& x) noexcept {
  const TensorReader::Reading& reading = tensors_->at(x);
  if (reading.status != SampleStatus::kOk) return {.status = reading.status};
  const Anisotropy& parts = reading.parts;
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

void IsotropicDrag::update(const Vec3& probe, const UpdateBudget&, LinkUpdate& link) noexcept {
  if (!caught_) proxy_ = probe;
  caught_ = true;
  const Vec3 away = probe - proxy_;
  const JointDrag drag = drag_jointly(away, Vec3{tau_});
  link.jacobian = drag.jacobian;
  proxy_ += drag.moved;
  link.proxy = proxy_;
  link.state = HoldState::kHeld;
}

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
