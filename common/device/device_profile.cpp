#include "common/device/device_profile.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/base/error.h"

namespace palpate {
namespace {

// PHANToM Premium 3.0 class. Apparent mass below 159 g, friction 0.2 N, 1000 dpi, 22 N, 3 N for any time, 838
// x 584 x 406 mm: the maker's data sheet; 1000 N/m and 22 N: the limits that open drivers use for it. Nobody
// states its viscous damping: 0.1 N s/m is the upper end of what is reported for the smaller Premium 1.0
// and 1.5 (Diolaiti et al. 2006).
constexpr DeviceProfile kPremium3{.name = "premium3",
                                  .title = "PHANToM Premium 3.0 class",
                                  .mass = 0.159,
                                  .damping = 0.1,
                                  .friction = 0.2,
                                  .encoder_step = 2.54e-5,
                                  .peak_force = 22.0,
                                  .continuous_force = 3.0,
                                  .reach = {0.838, 0.584, 0.406},
                                  .max_stiffness = 1000.0};

// Novint Falcon class. No identification of its mass and friction has been published that could be relied
// on: the middle of what its gearing (7.7 : 1) suggests. Step: 0.0364 degrees a count on arms of 60 mm, with
// the delta's ratio of about one and a half at the middle of its workspace. 8 N and 3000 N/m: the limits that
// open drivers use; a cube of 4 inches: the maker's. What its motors stand for any time is not stated: half
// the peak is assumed. It is read over a serial bridge with a latency of 1 ms.
constexpr DeviceProfile kFalcon{.name = "falcon",
                                .title = "Novint Falcon class",
                                .mass = 0.6,
                                .damping = 3.0,
                                .friction = 0.7,
                                .encoder_step = 6e-5,
                                .sensor_delay = 0.001,
                                .peak_force = 8.0,
                                .continuous_force = 4.0,
                                .reach = Vec3{0.1016},
                                .max_stiffness = 3000.0};

// Nothing but a mass and a damper: what theory is about.
constexpr DeviceProfile kIdeal{.name = "ideal",
                               .title = "a mass and a damper, without friction and encoder steps",
                               .mass = 0.1,
                               .damping = 2.0,
                               .peak_force = 40.0};

constexpr std::array kProfiles{kPremium3, kFalcon, kIdeal};

}  // namespace

bool DeviceProfile::valid() const noexcept {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  const auto not_negative = [](double x) { return std::isfinite(x) && x >= 0.0; };
  return positive(mass) && not_negative(damping) && not_negative(friction) && not_negative(encoder_step) &&
         not_negative(sensor_delay) && not_negative(actuator_delay) && positive(peak_force) &&
         positive(continuous_force) && positive(reach.x) && positive(reach.y) && positive(reach.z) &&
         positive(max_stiffness);
}

DeviceLimits safe_limits(const DeviceProfile& profile) noexcept {
  constexpr double kSlewCap = 200.0;     // [N/s]
  constexpr double kVelocityGate = 1.5;  // [m/s]
  constexpr double kStartRamp = 0.5;     // [s]
  DeviceLimits limits;
  limits.force_cap = profile.peak_force;
  limits.slew_cap = kSlewCap;
  limits.velocity_gate = kVelocityGate;
  limits.start_ramp = kStartRamp;
  limits.continuous_cap = profile.continuous_force;
  limits.reach_lower = -0.5 * profile.reach;
  limits.reach_upper = 0.5 * profile.reach;
  limits.latch_faults = true;
  return limits;
}

std::span<const DeviceProfile> device_profiles() noexcept { return kProfiles; }

const DeviceProfile& find_profile(std::string_view name) {
  const auto found = std::find_if(kProfiles.begin(), kProfiles.end(),
                                  [name](const DeviceProfile& each) { return each.name == name; });
  if (found != kProfiles.end()) return *found;
  std::string known;
  for (const DeviceProfile& each : kProfiles) (known += known.empty() ? "" : ", ") += each.name;
  throw usage_error("unknown simulated device '" + std::string(name) + "'; known are " + known);
}

}  // namespace palpate
