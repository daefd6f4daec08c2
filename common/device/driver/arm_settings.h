/// What links to arms that somebody else's software runs have in common: the frame that its maker chose, the
/// limits, and what no hand can have done.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "common/device/device_limits.h"
#include "common/math/quaternion.h"

namespace palpate {

/// From the frame of a maker (M) to frame D: x right, y up, z towards the user, from the middle of the
/// workspace.
struct ArmFrame {
  Mat3 device_from_maker{1.0};  ///< a rotation by right angles
  Vec3 middle{0.0};             ///< of the workspace [m] in M

  [[nodiscard]] Vec3 position(const Vec3& x_maker) const noexcept {
    return device_from_maker * (x_maker - middle);
  }
  /// position() as a motion.
  [[nodiscard]] Rigid rigid() const noexcept {
    return {glm::normalize(glm::quat_cast(device_from_maker)), -(device_from_maker * middle)};
  }
  [[nodiscard]] Vec3 force_for_maker(const Vec3& force) const noexcept {
    return glm::transpose(device_from_maker) * force;
  }
};

/// The axes of M that point right, up and towards the user, "yzx" or "xz-y". None for what is not a rotation.
[[nodiscard]] std::optional<Mat3> axes_from_text(std::string_view text) noexcept;

/// [N] of a cap: no arm at a desk has as much, and a larger one is a slip.
inline constexpr double kMostForceCap = 100.0;

struct ArmSettings {
  ArmFrame frame;
  double force_cap = 5.0;   ///< [N] whatever is asked for
  double reach = 0.1;       ///< [m] half a side of the cube in which there is force
  int enabling_button = 0;  ///< DeviceLimits::kNoButton: none

  [[nodiscard]] bool valid() const noexcept;
  /// The cap, the reach, 200 N/s, 1.5 m/s, half a second of ramp; faults are latched.
  [[nodiscard]] DeviceLimits limits() const noexcept;
};

/// Takes `axes`, `middle_x`, `middle_y`, `middle_z`, `reach` and `cap`.
/// @return false: it is none of these. @throws Error (usage) for a value that makes no sense.
bool take_arm_option(ArmSettings& settings, std::string_view driver, const std::string& name,
                     const std::string& value);
/// Of these options, a line each. @param axes the driver's default.
[[nodiscard]] std::string arm_help(const ArmSettings& defaults, std::string_view axes);
inline constexpr std::string_view kArmOptions = "axes, middle_x, middle_y, middle_z, reach, cap";

/// `force`, finite and no longer than `cap`; zero for what is no number.
[[nodiscard]] Vec3 force_within(const Vec3& force, double cap) noexcept;

/// Whether a hand can have moved so in `seconds`: 3 m/s, twice any velocity gate, and what jitter makes of
/// it.
[[nodiscard]] inline bool plausible_move(const Vec3& from, const Vec3& to, double seconds) noexcept {
  constexpr double kFastest = 3.0;   // [m/s]
  constexpr double kAnyway = 0.005;  // [m]
  return is_finite(to) && glm::distance(from, to) <= kAnyway + kFastest * std::max(0.0, seconds);
}

/// After an arm took its force away by itself there is none until none was asked for: a force does not come
/// back under a hand that still leans on it. What trips it may be another thread than the one that shows.
class ForceRearm {
 public:
  void trip() noexcept { tripped_.store(true, std::memory_order_release); }
  [[nodiscard]] bool tripped() const noexcept { return tripped_.load(std::memory_order_acquire); }
  /// What of `asked` may be shown.
  [[nodiscard]] Vec3 allowed(const Vec3& asked) noexcept {
    if (asked == Vec3{0.0}) tripped_.store(false, std::memory_order_release);
    return tripped() ? Vec3{0.0} : asked;
  }

 private:
  std::atomic<bool> tripped_{false};
};

}  // namespace palpate
