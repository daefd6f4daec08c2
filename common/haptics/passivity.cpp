#include "common/haptics/passivity.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double kArmDamping = 0.1;  // b_0 [N s/m]: the least of the profiles in device/device_profile.h

}  // namespace

Vec3 PassivityController::control(const Vec3& position, double dt, const Vec3& force, double stored,
                                  const PassivitySettings& settings) noexcept {
  const Vec3 moved = known_ ? position - last_ : Vec3{0.0};
  last_ = position;
  known_ = true;
  const double square = glm::dot(moved, moved);
  const double lost = dt > 0.0 ? kArmDamping * square / dt : 0.0;
  energy_ = std::min(energy_ - glm::dot(held_, moved) + lost, stored);
  if (!std::isfinite(energy_)) energy_ = 0.0;  // a jump beyond all bounds
  idle_ = held_ == Vec3{0.0} && force == Vec3{0.0} ? idle_ + dt : 0.0;
  if (idle_ >= kForgetAfter) energy_ = std::max(energy_, 0.0);
  damping_ = 0.0;
  const double dead = settings.dead_speed * dt;
  if (!(energy_ < 0.0) || !(square > dead * dead)) return force;
  damping_ = std::min(-energy_ * dt / square, settings.max_damping);
  return force - (damping_ / dt) * moved;
}

}  // namespace palpate
