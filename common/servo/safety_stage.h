/// The last stage before the device: whatever force is asked for, what leaves here is finite, no larger than
/// the cap, and grows and turns no faster than the slew limit. The rules themselves are in safety_stage.h.
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
#include <string_view>

#include "common/device/device_limits.h"
#include "common/math/vec.h"

namespace palpate {

// The rules of the safety stage, each a function of its arguments alone. SafetyStage (safety_stage.h) is the
// one place that applies them.
//
// Symbols: F force [N], C cap [N], F_c largest force that may last [N], dt time since the last step [s].

/// Why a force is zero, or on its way there, whatever was asked for.
enum class ForceCut : std::uint8_t {
  kNone,         ///< it is not cut
  kNoHand,       ///< no hand on the device
  kStart,        ///< first step, a new chain or hand, or after a stall: the force grows from here
  kJump,         ///< a proxy changed to another feature: the force grows from here
  kSwitchedOff,  ///< latched until arm()
  kOutOfReach,   ///< the hand is outside of the device's workspace
  kReleased,     ///< the enabling button is not held; fades out
  kTooFast,      ///< the hand passed the velocity gate; latched until arm()
  kStale,        ///< fault: the sample is too old; fades out
  kTime,         ///< fault: time stood still or ran backwards
  kNotFinite,    ///< fault: the sample or the force is no finite number
  kChain         ///< fault: the chain could make no sense of its input
};
inline constexpr int kForceCutCount = 12;
[[nodiscard]] std::string_view name_of(ForceCut cut) noexcept;  ///< "switched_off"
/// Whether it says that something is wrong, rather than wanted.
[[nodiscard]] constexpr bool is_fault(ForceCut cut) noexcept { return cut >= ForceCut::kTooFast; }
/// Whether the force fades out, keeping its direction, rather than drop: the hand still leans on it.
[[nodiscard]] constexpr bool fades_out(ForceCut cut) noexcept {
  return cut == ForceCut::kReleased || cut == ForceCut::kStale;
}

/// `force` shortened to `cap` where it is longer, its direction kept; without overflow for any finite force.
/// @pre is_finite(force), cap >= 0.
[[nodiscard]] Vec3 capped(const Vec3& force, double cap) noexcept;

/// As far from `previous` towards `wanted` as a step of the length `most` goes.
/// @pre both finite and far from overflow, most >= 0.
[[nodiscard]] Vec3 slewed(const Vec3& previous, const Vec3& wanted, double most) noexcept;

/// `force` after dt of a straight fall to zero that has the time `left` for it.
[[nodiscard]] Vec3 faded(const Vec3& force, double dt, double left) noexcept;

/// How warm the motors are, as the square of the steady force that would warm them as much: h [N^2] after
/// `force` has been shown for dt,  tau dh/dt = |F|^2 - h, solved exactly.
[[nodiscard]] double warmed(double heat, const Vec3& force, double dt, double heating_time) noexcept;

/// The cap after `time` since the start, with motors as warm as `heat`: the lesser of
///
///   C min(1, t / ramp)   and   sqrt(F_c^2 + (C^2 - F_c^2) max(0, 1 - h / F_c^2)),
///
/// so that a cold device may show its peak and one that keeps showing it comes down to F_c, without a step.
[[nodiscard]] double cap_after(const DeviceLimits& limits, double time, double heat) noexcept;

/// The push back into the reach, along each axis  k (m - d)  at a distance d < m from the border. Zero where
/// nothing bounds it. @pre within_reach().
[[nodiscard]] Vec3 edge_push(const DeviceLimits& limits, const Vec3& x) noexcept;
/// False for NaN too.
[[nodiscard]] bool within_reach(const DeviceLimits& limits, const Vec3& x) noexcept;

/// An enabling button says nothing once it is this old [s]: with the time that a force takes to fade out
/// (DeviceLimits::fade_time) and some steps of the servo, less than 0.1 s from losing it to zero.
inline constexpr double kEnablingStale = 0.040;
/// Whether the enabling button is held, or none is needed. @param age [s] of `buttons`.
[[nodiscard]] bool is_enabled(const DeviceLimits& limits, std::uint32_t buttons, double age) noexcept;

/// One step's wish. Nothing in it need be finite.
struct ForceRequest {
  Vec3 force{0.0};                 ///< [N]
  double dt = 0.0;                 ///< [s] since the last step
  double age = 0.0;                ///< [s] of the sample that it rests on
  double speed = 0.0;              ///< [m/s] of the hand (hand_speed.h)
  ForceCut cut = ForceCut::kNone;  ///< the caller's own reason for a zero force
  Vec3 position{0.0};              ///< [m] of the hand, in the frame of the limits' reach
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
