/// What is known of a force device: how its arm moves, what its encoders and motors can do.
///
/// The numbers of the presets are those of a class of devices, put together from published ones, and not
/// measured on any single device: see device_profile.cpp for the source of each.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "common/device/device_limits.h"
#include "common/math/vec.h"

namespace palpate {

struct DeviceProfile {
  std::string_view name;            ///< "premium3"
  std::string_view title;           ///< "PHANToM Premium 3.0 class"
  double mass = 0.1;                ///< apparent, at the tip [kg]
  double damping = 0.0;             ///< viscous, of the arm itself [N s/m]
  double friction = 0.0;            ///< Coulomb [N]
  double encoder_step = 0.0;        ///< position quantum at the tip [m]; 0: none
  double sensor_delay = 0.0;        ///< from the arm being there to its being read [s]
  double actuator_delay = 0.0;      ///< from a command to its force [s]
  double peak_force = 4.0;          ///< the motors give no more [N]
  double continuous_force = 1e300;  ///< that its motors stand for any time [N]
  Vec3 reach{1e300};  ///< sides of the box in which its tip can be, right, up, towards the hand [m]
  double max_stiffness = 1e300;  ///< that its maker states, or is known to be stable [N/m]

  /// Whether every value can be used: finite, none below zero, mass and forces above it.
  [[nodiscard]] bool valid() const noexcept;
};

/// What a force on such a device is held to, whatever is asked for: its peak, what its motors stand for any
/// time, 200 N/s of growth and turn, 1.5 m/s of speed, half a second of ramp after every start; faults last
/// until the force is armed again. The reach lies about the middle of the device (frame D); no button is
/// needed. Speed and ramp are in the range that device makers use for theirs. This is no certified safety
/// function.
[[nodiscard]] DeviceLimits safe_limits(const DeviceProfile& profile) noexcept;

/// The default one first.
[[nodiscard]] std::span<const DeviceProfile> device_profiles() noexcept;
/// @throws Error (usage) that lists the known ones.
[[nodiscard]] const DeviceProfile& find_profile(std::string_view name);

}  // namespace palpate
