/// The rules of the safety stage, each a function of its arguments alone. SafetyStage (safety_stage.h) is the
/// one place that applies them.
///
/// Symbols: F force [N], C cap [N], F_c largest force that may last [N], dt time since the last step [s].
#pragma once

#include <cstdint>
#include <string_view>

#include "common/device/device_limits.h"
#include "common/math/vec.h"

namespace palpate {

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

}  // namespace palpate
