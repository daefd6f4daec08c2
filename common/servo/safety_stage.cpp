#include "common/servo/safety_stage.h"

#include <algorithm>
#include <array>

namespace palpate {

std::string_view name_of(ForceCut cut) noexcept {
  constexpr std::array<std::string_view, 11> kNames{"none", "no_hand",      "paused",   "start",
                                                    "jump", "switched_off", "too_fast", "stale",
                                                    "time", "not_finite",   "chain"};
  return kNames[static_cast<std::size_t>(cut)];
}

Vec3 capped(const Vec3& force, double cap) noexcept {
  // In units of the largest component: squares of it neither overflow nor vanish.
  const double largest = std::max({std::abs(force.x), std::abs(force.y), std::abs(force.z)});
  if (largest == 0.0) return Vec3{0.0};
  const Vec3 scaled = force / largest;
  const double length = glm::length(scaled);  // in [1, sqrt 3]
  if (length <= cap / largest) return force;
  return scaled * (cap / length);
}

Vec3 slewed(const Vec3& previous, const Vec3& wanted, double most) noexcept {
  const Vec3 change = wanted - previous;
  const double length = glm::length(change);
  return length <= most ? wanted : previous + change * (most / length);
}

Vec3 SafetyStage::apply(const ForceRequest& request) noexcept {
  cut_ = reason_to_cut(request);
  if (cut_ != ForceCut::kNone) {
    force_ = Vec3{0.0};
    if (cut_ != ForceCut::kJump) ramp_time_ = 0.0;  // popping over is part of the feel, not a start
    return force_;
  }
  const double dt = std::min(request.dt, kLongestStep);
  ramp_time_ += dt;
  const double cap =
      limits_.force_cap * (ramp_time_ < limits_.start_ramp ? ramp_time_ / limits_.start_ramp : 1.0);
  const Vec3 wanted = capped(request.force, cap);
  // Capped again: a sum of two vectors under the cap passes it by a rounding.
  force_ = wanted == Vec3{0.0} ? wanted : capped(slewed(force_, wanted, limits_.slew_cap * dt), cap);
  return force_;
}

ForceCut SafetyStage::reason_to_cut(const ForceRequest& request) noexcept {
  if (latch_ != ForceCut::kNone) return latch_;
  if (request.cut != ForceCut::kNone) return request.cut;
  // Each written so that NaN fails it.
  if (!(request.dt > 0.0)) return ForceCut::kTime;
  if (!(request.age <= limits_.stale_after)) return ForceCut::kStale;
  if (!is_finite(request.force)) return ForceCut::kNotFinite;
  if (!(request.speed <= limits_.velocity_gate)) return latch_ = ForceCut::kTooFast;
  return ForceCut::kNone;
}

}  // namespace palpate
