#include "common/haptics/constraint/noise_texture.h"

#include <utility>

namespace palpate {

NoiseTexture::NoiseTexture(std::shared_ptr<const ScalarField> noise, const Workspace& workspace,
                           const IsosurfaceConstraint* surface)
    : noise_(std::move(noise)), workspace_(workspace), surface_(surface) {}

/// tau of (1) [m]; 0 where nothing is textured.
double NoiseTexture::grain_at(const Vec3& probe) noexcept {
  if (surface_ != nullptr && surface_->held_by() < 0) return 0.0;
  const ScalarSample noise = noise_->sample(workspace_.data_from_workspace(probe), hint_);
  return noise.status == SampleStatus::kOk ? grain_(noise.value) : 0.0;
}

void NoiseTexture::update(const Vec3& probe, const UpdateBudget& /*budget*/, LinkUpdate& link) noexcept {
  const double grain = grain_at(probe);
  if (!sticks_ || !(glm::distance(probe, proxy_) <= grain)) proxy_ = probe;
  sticks_ = grain > 0.0;
  link.proxy = proxy_;
  if (!sticks_) return;
  link.state = HoldState::kHeld;
  link.jacobian = Mat3{0.0};
}

}  // namespace palpate
