/// The last stage before the device: whatever force is asked for, what leaves here is finite, no larger than
/// the cap, and changes no faster than the slew limit, but for a drop to zero, which is immediate.
///
/// Symbols: F_n force of step n [N], C cap [N], S slew limit [N/s], dt time since the last step [s].
///
///   |F_n| <= C            |F_n - F_(n-1)| <= S min(dt, kLongestStep)   or   F_n = 0
///
/// The second bounds growth, turning and a partial fall alike. After any cut F grows from zero again.
/// This is no certified safety function.
#pragma once

#include <cmath>
#include <cstdint>
#include <string_view>

#include "common/device/device.h"
#include "common/math/vec.h"

namespace palpate {

/// Why a force is exactly zero whatever was asked for.
enum class ForceCut : std::uint8_t {
  kNone,         ///< it is not cut
  kNoHand,       ///< no hand on the device
  kPaused,       ///< the servo was told to hold still
  kStart,        ///< first step, a new chain, or after a stall: the force grows from here
  kJump,         ///< a proxy changed to another feature: the force grows from here
  kSwitchedOff,  ///< latched until arm()
  kTooFast,      ///< the hand passed the velocity gate; latched until arm()
  kStale,        ///< fault: the sample is too old
  kTime,         ///< fault: time stood still or ran backwards
  kNotFinite,    ///< fault: the sample or the force is no finite number
  kChain         ///< fault: the chain could make no sense of its input
};
[[nodiscard]] std::string_view name_of(ForceCut cut) noexcept;  ///< "switched_off"
/// Whether it says that something is wrong, rather than wanted.
[[nodiscard]] constexpr bool is_fault(ForceCut cut) noexcept { return cut >= ForceCut::kTooFast; }

/// `force` shortened to `cap` where it is longer, its direction kept; without overflow for any finite force.
/// @pre is_finite(force), cap >= 0.
[[nodiscard]] Vec3 capped(const Vec3& force, double cap) noexcept;

/// As far from `previous` towards `wanted` as a step of the length `most` goes.
/// @pre both finite and far from overflow, most >= 0.
[[nodiscard]] Vec3 slewed(const Vec3& previous, const Vec3& wanted, double most) noexcept;

/// One step's wish. Nothing in it need be finite.
struct ForceRequest {
  Vec3 force{0.0};                 ///< [N]
  double dt = 0.0;                 ///< [s] since the last step
  double age = 0.0;                ///< [s] of the sample that it rests on
  double speed = 0.0;              ///< [m/s] of the hand
  ForceCut cut = ForceCut::kNone;  ///< the caller's own reason for a zero force
};

class SafetyStage {
 public:
  static constexpr double kLongestStep = 0.020;  ///< [s] a longer pause buys no larger change of force

  /// @pre limits.valid().
  explicit SafetyStage(const DeviceLimits& limits) noexcept : limits_(limits) {}

  /// The force for the device; cut() says why it is zero. @rt Safe.
  [[nodiscard]] Vec3 apply(const ForceRequest& request) noexcept;
  [[nodiscard]] ForceCut cut() const noexcept { return cut_; }

  /// Zero force from now on, until arm().
  void switch_off() noexcept { latch_ = ForceCut::kSwitchedOff; }
  /// Allows force again, grown from zero.
  void arm() noexcept { latch_ = ForceCut::kNone; }
  [[nodiscard]] bool armed() const noexcept { return latch_ == ForceCut::kNone; }

  [[nodiscard]] const DeviceLimits& limits() const noexcept { return limits_; }

 private:
  [[nodiscard]] ForceCut reason_to_cut(const ForceRequest& request) noexcept;

  DeviceLimits limits_;
  Vec3 force_{0.0};         ///< F_(n-1)
  double ramp_time_ = 0.0;  ///< [s] since the start or the last fault
  ForceCut latch_ = ForceCut::kNone;
  ForceCut cut_ = ForceCut::kNone;
};

}  // namespace palpate
