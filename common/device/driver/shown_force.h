/// The force that a link tells its device: the last thing that every force passes, behind the safety stage,
/// the placement, the calibration and all that a link itself takes away.
///
///   |F_n| <= C            |F_n - lambda F_(n-1)| <= S min(dt, kLongestStep) for some lambda in [0, 1]
///
/// the promise of the safety stage (servo/safety_stage.h), kept at the wire: a force may fall at once, but
/// where an answer was missing, a gate opened or orders stood still it does not come back in one step.
///
/// Symbols: F_n force of command n [N], C cap [N], S slew limit [N/s], dt time since the last command [s].
#pragma once

#include <algorithm>
#include <optional>

#include "common/device/device_limits.h"
#include "common/device/driver/arm_settings.h"

namespace palpate {

class ShownForce {
 public:
  static constexpr double kLongestStep = 0.020;  ///< [s] a longer pause buys no larger change of force

  explicit ShownForce(const DeviceLimits& limits) noexcept : cap_(limits.force_cap), slew_(limits.slew_cap) {}

  /// Lowers C and S to those of `asked`, where they are lower.
  void restrain(const DeviceLimits& asked) noexcept {
    cap_ = std::min(cap_, asked.force_cap);
    slew_ = std::min(slew_, asked.slew_cap);
  }

  /// The force to show at `now` [s], as near to `wanted` as the rules allow; zero for what is no number.
  /// @rt Safe.
  [[nodiscard]] Vec3 next(const Vec3& wanted, double now) noexcept {
    const Vec3 held = force_within(wanted, cap_);
    const double dt = last_ ? std::clamp(now - *last_, 0.0, kLongestStep) : 0.0;  // none before the first
    last_ = now;
    // What is left of the last force on the way to the new one.
    const double square = glm::dot(force_, force_);
    const double left = square > 0.0 ? std::clamp(glm::dot(held, force_) / square, 0.0, 1.0) : 0.0;
    const Vec3 from = left * force_, change = held - from;
    const double length = glm::length(change), most = slew_ * dt;
    return force_ = length <= most ? held : force_within(from + change * (most / length), cap_);
  }

 private:
  double cap_, slew_;
  Vec3 force_{0.0};             ///< F_(n-1)
  std::optional<double> last_;  ///< [s]
};

}  // namespace palpate
