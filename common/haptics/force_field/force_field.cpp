#include "common/haptics/force_field/force_field.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/haptics/fade.h"
#include "common/haptics/frame_along.h"

namespace palpate {
namespace {

/// Without vortices.
FlowScale scale_of(const VectorField& field) noexcept {
  const double diagonal = field.diagonal(), speed = field.max_speed();
  return {.speed = speed, .vorticity = diagonal > 0.0 ? speed / diagonal : 0.0};
}

/// What a hundredth of the values exceed; 0 where there are none.
double strong(std::vector<double>& values) {
  if (values.empty()) return 0.0;
  constexpr double kPart = 0.99;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(kPart * static_cast<double>(values.size()));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// W on a lattice over the bounds.
double strong_lamb_vector(const VectorField& field, const VorticityField& vorticity, const FlowScale& scale) {
  constexpr int kLattice = 32;       // points an axis
  constexpr double kAligned = 0.05;  // of |omega| |v|
  const Box& bounds = field.bounds();
  const Vec3 step = bounds.size() / static_cast<double>(kLattice);
  CellHint hint, vorticity_hint;
  std::vector<double> across, whole;
  for (int k = 0; k < kLattice; ++k) {
    for (int j = 0; j < kLattice; ++j) {
      for (int i = 0; i < kLattice; ++i) {
        const Vec3 x = bounds.lower + step * Vec3{i + 0.5, j + 0.5, k + 0.5};
        const VectorSample v = field.sample(x, hint), omega = vorticity.sample(x, vorticity_hint);
        if (v.status != SampleStatus::kOk || omega.status != SampleStatus::kOk) continue;
        across.push_back(glm::length(lamb_vector(omega.value, v.value, scale)));
        whole.push_back(glm::length(omega.value / scale.vorticity) * glm::length(v.value / scale.speed));
      }
    }
  }
  return std::max(strong(across), kAligned * strong(whole));
}

}  // namespace

double density_part(double value, double lowest, double highest) noexcept {
  if (!(highest > lowest)) return 0.0;
  return std::clamp((value - lowest) / (highest - lowest), 0.0, 1.0);
}

Vec3 direct_force(const Vec3& v, const FlowScale& scale, double strength) noexcept {
  return scale.speed > 0.0 ? strength * (v / scale.speed) : Vec3{0.0};
}

Vec3 lamb_vector(const Vec3& omega, const Vec3& v, const FlowScale& scale) noexcept {
  // Each in its own unit first: the product of both in data units may overflow or vanish.
  return scale.speed > 0.0 && scale.vorticity > 0.0 ? glm::cross(omega / scale.vorticity, v / scale.speed)
                                                    : Vec3{0.0};
}

Vec3 vortex_force(const Vec3& omega, const Vec3& v, const FlowScale& scale, double strength) noexcept {
  if (!(scale.lamb > 0.0)) return Vec3{0.0};
  const Vec3 w = lamb_vector(omega, v, scale) / scale.lamb;
  return strength * (w / std::max(1.0, glm::length(w)));
}

AxisDrag transverse_drag(const Vec3& v, const FlowScale& scale, double damping, double fade_speed) noexcept {
  if (!(scale.speed > 0.0)) return {};
  const Vec3 scaled = v / scale.speed;
  const double speed = glm::length(scaled);
  if (!(speed > 0.0)) return {};
  const double b = damping * fade(speed / fade_speed);
  return {frame_along(scaled / speed), Vec3{0.0, b, b}};
}

void ForceField::update(const Vec3& probe, const UpdateBudget& /*budget*/, LinkUpdate& link) noexcept {
  link.proxy = probe;
  link.kappa = Vec3{0.0};
  const SampleStatus status = feel(workspace_.data_from_workspace(probe), hint_, link);
  link.state = status == SampleStatus::kOk ? HoldState::kHeld : HoldState::kOutside;
}

DirectDisplay::DirectDisplay(std::shared_ptr<const VectorField> field, const Workspace& workspace)
    : ForceField(workspace), field_(std::move(field)), scale_(scale_of(*field_)) {}

SampleStatus DirectDisplay::feel(const Vec3& x_data, CellHint& hint, LinkUpdate& link) const noexcept {
  const VectorSample v = field_->sample(x_data, hint);
  if (v.status == SampleStatus::kOk) link.extra_force = direct_force(v.value, scale_, settings().strength);
  return v.status;
}

VortexPull::VortexPull(std::shared_ptr<const VectorField> field, const Workspace& workspace)
    : ForceField(workspace), field_(std::move(field)), vorticity_(field_), scale_(scale_of(*field_)) {
  if (scale_.vorticity > 0.0) scale_.lamb = strong_lamb_vector(*field_, vorticity_, scale_);
}

SampleStatus VortexPull::feel(const Vec3& x_data, CellHint& hint, LinkUpdate& link) const noexcept {
  const VectorSample v = field_->sample(x_data, hint);
  if (v.status != SampleStatus::kOk) return v.status;
  const VectorSample omega = vorticity_.sample(x_data, hint);
  if (omega.status != SampleStatus::kOk) return omega.status;
  link.extra_force = vortex_force(omega.value, v.value, scale_, settings().strength);
  return SampleStatus::kOk;
}

TransverseDamping::TransverseDamping(std::shared_ptr<const VectorField> field, const Workspace& workspace)
    : ForceField(workspace), field_(std::move(field)), scale_(scale_of(*field_)) {}

SampleStatus TransverseDamping::feel(const Vec3& x_data, CellHint& hint, LinkUpdate& link) const noexcept {
  const VectorSample v = field_->sample(x_data, hint);
  if (v.status != SampleStatus::kOk) return v.status;
  const AxisDrag drag = transverse_drag(v.value, scale_, settings().damping, settings().fade_speed);
  link.frame = drag.frame;
  link.damping = drag.damping;
  return SampleStatus::kOk;
}

DensityDrag::DensityDrag(std::shared_ptr<const ScalarField> field, const Workspace& workspace)
    : ForceField(workspace), field_(std::move(field)) {}

SampleStatus DensityDrag::feel(const Vec3& x_data, CellHint& hint, LinkUpdate& link) const noexcept {
  const ScalarSample s = field_->sample(x_data, hint);
  if (s.status == SampleStatus::kOk) {
    const double part = density_part(s.value, field_->lowest(), field_->highest());
    link.damping = Vec3{settings().damping * settings().density(part)};
  }
  return s.status;
}

}  // namespace palpate
