#include "common/servo/safety_stage.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>

#include "common/base/index.h"

namespace palpate {

std::string_view name_of(ForceCut cut) noexcept {
  constexpr std::array<std::string_view, kForceCutCount> kNames{
      "none",     "no_hand",  "start", "jump", "switched_off", "out_of_reach",
      "released", "too_fast", "stale", "time", "not_finite",   "chain"};
  return kNames[as_size(cut)];
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

Vec3 faded(const Vec3& force, double dt, double left) noexcept {
  return dt < left ? force * (1.0 - dt / left) : Vec3{0.0};
}

double warmed(double heat, const Vec3& force, double dt, double heating_time) noexcept {
  return heat - (glm::dot(force, force) - heat) * std::expm1(-dt / heating_time);
}

double cap_after(const DeviceLimits& limits, double time, double heat) noexcept {
  const double cap = limits.force_cap;
  double allowed = time < limits.start_ramp ? cap * (time / limits.start_ramp) : cap;
  if (limits.continuous_cap < cap) {
    const double lasting = limits.continuous_cap * limits.continuous_cap;
    const double cold = std::max(0.0, 1.0 - heat / lasting);
    allowed = std::min(allowed, std::sqrt(lasting + (cap * cap - lasting) * cold));
  }
  return allowed;
}

Vec3 edge_push(const DeviceLimits& limits, const Vec3& x) noexcept {
  const Vec3 from_lower = glm::min(x - limits.reach_lower, limits.edge_margin);
  const Vec3 from_upper = glm::min(limits.reach_upper - x, limits.edge_margin);
  return limits.edge_stiffness * (from_upper - from_lower);
}

bool within_reach(const DeviceLimits& limits, const Vec3& x) noexcept {
  return glm::all(glm::greaterThanEqual(x, limits.reach_lower)) &&
         glm::all(glm::lessThanEqual(x, limits.reach_upper));
}

bool is_enabled(const DeviceLimits& limits, std::uint32_t buttons, double age) noexcept {
  if (limits.enabling_button == DeviceLimits::kNoButton) return true;
  return ((buttons >> static_cast<unsigned>(limits.enabling_button)) & 1U) != 0 && age <= kEnablingStale;
}

Vec3 SafetyStage::apply(const ForceRequest& request) noexcept {
  const bool timed = request.dt > 0.0;  // false for NaN
  // What has been shown since the last step warms the motors, and time without force cools them.
  if (timed) heat_ = warmed(heat_, force_, request.dt, limits_.heating_time);
  cut_ = reason_to_cut(request);
  if (cut_ == ForceCut::kTooFast || (is_fault(cut_) && limits_.latch_faults)) latch_ = cut_;
  if (cut_ == ForceCut::kNone) return force_ = follow(request);

  if (cut_ != ForceCut::kJump) ramp_time_ = 0.0;  // popping over is part of the feel, not a start
  // Nor is there any outside of the reach where it would fade: a latched fault may meet a hand that is there.
  const bool fades = fades_out(cut_) && timed && within_reach(limits_, request.position);
  return force_ = fades ? fade(request.dt) : Vec3{0.0};
}

ForceCut SafetyStage::reason_to_cut(const ForceRequest& request) const noexcept {
  if (latch_ != ForceCut::kNone) return latch_;
  if (is_fault(request.cut)) return request.cut;
  // Each written so that NaN fails it. A hand that is too fast latches whatever else keeps the force at zero.
  if (!(request.speed <= limits_.velocity_gate)) return ForceCut::kTooFast;
  if (request.cut != ForceCut::kNone) return request.cut;
  if (!(request.dt > 0.0)) return ForceCut::kTime;
  if (!(request.age <= limits_.stale_after)) return ForceCut::kStale;
  if (!is_finite(request.force)) return ForceCut::kNotFinite;
  if (!within_reach(limits_, request.position)) return ForceCut::kOutOfReach;
  if (!is_enabled(limits_, request.buttons, request.age)) return ForceCut::kReleased;
  return ForceCut::kNone;
}

Vec3 SafetyStage::fade(double dt) noexcept {
  const double left = limits_.fade_time - fade_time_;
  fade_time_ += dt;
  return faded(force_, dt, left);
}

Vec3 SafetyStage::follow(const ForceRequest& request) noexcept {
  const double dt = std::min(request.dt, kLongestStep);
  ramp_time_ += dt;
  fade_time_ = 0.0;
  const double cap = cap_after(limits_, ramp_time_, heat_);
  // Capped before the push, which a strong pull outwards would drown otherwise.
  const Vec3 wanted = capped(capped(request.force, cap) + edge_push(limits_, request.position), cap);
  // Capped again: the cap may have come down, and a sum of two vectors under it passes it by a rounding.
  return wanted == Vec3{0.0} ? wanted : capped(slewed(force_, wanted, limits_.slew_cap * dt), cap);
}

}  // namespace palpate
