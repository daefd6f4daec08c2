#include "common/haptics/tensor_frame.h"

#include "common/field/tensor/eigenframe.h"
#include "common/haptics/fade.h"
#include "common/math/symmetric3.h"

namespace palpate {

TensorReader::TensorReader(std::shared_ptr<const TensorField> field, const Workspace& workspace)
    : field_(std::move(field)), workspace_(workspace), full_trace_(kFullPart * field_->typical_trace()) {}

const TensorReader::Reading& TensorReader::at(const Vec3& x) noexcept {
  if (x == place_) return reading_;
  place_ = x;
  const TensorSample sample = field_->sample(workspace_.data_from_workspace(x), hint_);
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
  const TensorReader::Reading& reading = tensors_->at(x);
  if (reading.status != SampleStatus::kOk) return {.axes = last, .status = reading.status};
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

}  // namespace palpate
