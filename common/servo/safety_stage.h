/// The last stage before the device: whatever force is asked for, what leaves here is finite, no larger than
/// the cap, and grows and turns no faster than the slew limit. The rules themselves are in safety_rules.h.
///
/// Symbols: F_n force of step n [N], C cap [N], S slew limit [N/s], dt time since the last step [s].
///
///   |F_n| <= C            |F_n - lambda F_(n-1)| <= S min(dt, kLongestStep) for some lambda in [0, 1]
///
/// So falling is free: a force drops to zero at once where it must (ForceCut), and fades out within
/// DeviceLimits::fade_time where the hand may lean on it. From anything that makes it zero it grows anew,
/// under a cap that rises from zero over DeviceLimits::start_ramp.
///
/// Latched reasons last until arm(); nothing else switches the force on again.
/// This is no certified safety function.
#pragma once

#include <cstdint>

#include "common/device/device_limits.h"
#include "common/math/vec.h"
#include "common/servo/safety_rules.h"

namespace palpate {

/// One step's wish. Nothing in it need be finite.
struct ForceRequest {
  Vec3 force{0.0};                 ///< [N]
  double dt = 0.0;                 ///< [s] since the last step
  double age = 0.0;                ///< [s] of the sample that it rests on
  double speed = 0.0;              ///< [m/s] of the hand
  ForceCut cut = ForceCut::kNone;  ///< the caller's own reason for a zero force
  Vec3 position{0.0};              ///< [m] of the hand
  std::uint32_t buttons = 0;       ///< bit i: button i is down
};

class SafetyStage {
 public:
  static constexpr double kLongestStep = 0.020;  ///< [s] a longer pause buys no larger change of force

  /// @pre limits.valid().
  explicit SafetyStage(const DeviceLimits& limits) noexcept : limits_(limits) {}

  /// The force for the device; cut() says why it is zero or fades. @rt Safe.
  [[nodiscard]] Vec3 apply(const ForceRequest& request) noexcept;
  [[nodiscard]] ForceCut cut() const noexcept { return cut_; }

  /// Zero force from now on, until arm().
  void switch_off() noexcept { latch_ = ForceCut::kSwitchedOff; }
  /// Allows force again, grown from zero.
  void arm() noexcept { latch_ = ForceCut::kNone; }
  [[nodiscard]] bool armed() const noexcept { return latch_ == ForceCut::kNone; }

  [[nodiscard]] const DeviceLimits& limits() const noexcept { return limits_; }

 private:
  [[nodiscard]] ForceCut reason_to_cut(const ForceRequest& request) const noexcept;
  [[nodiscard]] Vec3 fade(double dt) noexcept;
  [[nodiscard]] Vec3 follow(const ForceRequest& request) noexcept;

  DeviceLimits limits_;
  Vec3 force_{0.0};         ///< F_(n-1)
  double fade_time_ = 0.0;  ///< [s] for which it has been fading
  double ramp_time_ = 0.0;  ///< [s] since the start, or the last cut other than a jump
  double heat_ = 0.0;       ///< [N^2], see warmed()
  ForceCut latch_ = ForceCut::kNone;
  ForceCut cut_ = ForceCut::kNone;
};

}  // namespace palpate
