#include "common/servo/safety_stage.h"

#include <algorithm>

namespace palpate {

Vec3 SafetyStage::apply(const ForceRequest& request) noexcept {
  const bool timed = request.dt > 0.0;  // false for NaN
  // What has been shown since the last step warms the motors, and time without force cools them.
  if (timed) heat_ = warmed(heat_, force_, request.dt, limits_.heating_time);
  cut_ = reason_to_cut(request);
  if (cut_ == ForceCut::kTooFast || (is_fault(cut_) && limits_.latch_faults)) latch_ = cut_;
  if (cut_ == ForceCut::kNone) return force_ = follow(request);

  if (cut_ != ForceCut::kJump) ramp_time_ = 0.0;  // popping over is part of the feel, not a start
  return force_ = fades_out(cut_) && timed ? fade(request.dt) : Vec3{0.0};
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
