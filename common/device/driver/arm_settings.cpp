#include "common/device/driver/arm_settings.h"

#include <array>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {
namespace {

/// A number of the settings by its name.
struct ArmNumber {
  std::string_view name;
  double& (*in)(ArmSettings&);
};

constexpr double kMostReach = 10.0;  // [m] no arm is longer

constexpr std::array kArmNumbers{
    ArmNumber{"middle_x", [](ArmSettings& s) -> double& { return s.frame.middle.x; }},
    ArmNumber{"middle_y", [](ArmSettings& s) -> double& { return s.frame.middle.y; }},
    ArmNumber{"middle_z", [](ArmSettings& s) -> double& { return s.frame.middle.z; }},
    ArmNumber{"reach", [](ArmSettings& s) -> double& { return s.reach; }},
    ArmNumber{"cap", [](ArmSettings& s) -> double& { return s.force_cap; }}};

}  // namespace

std::optional<Mat3> axes_from_text(std::string_view text) noexcept {
  // Row i of the matrix is the axis of M that axis i of D is.
  Mat3 axes{0.0};
  int row = 0;
  double sign = 1.0;
  for (const char letter : text) {
    if (letter == '-' || letter == '+') {
      sign = letter == '-' ? -1.0 : 1.0;
      continue;
    }
    if (letter < 'x' || letter > 'z' || row == 3) return std::nullopt;
    axes[letter - 'x'][row++] = sign;
    sign = 1.0;
  }
  return row == 3 && glm::determinant(axes) == 1.0 ? std::optional(axes) : std::nullopt;
}

bool ArmSettings::valid() const noexcept {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  return is_finite(frame.middle) && positive(force_cap) && force_cap <= kMostForceCap && positive(reach) &&
         reach <= kMostReach;
}

DeviceLimits ArmSettings::limits() const noexcept {
  constexpr double kSlewCap = 200.0;     // [N/s]
  constexpr double kVelocityGate = 1.5;  // [m/s]
  constexpr double kStartRamp = 0.5;     // [s]
  constexpr double kStale = 0.020;       // [s]
  DeviceLimits limits;
  limits.force_cap = force_cap;
  limits.slew_cap = kSlewCap;
  limits.velocity_gate = kVelocityGate;
  limits.start_ramp = kStartRamp;
  limits.stale_after = kStale;
  limits.reach_lower = Vec3{-reach};
  limits.reach_upper = Vec3{reach};
  limits.enabling_button = enabling_button;
  limits.latch_faults = true;
  return limits;
}

bool take_arm_option(ArmSettings& settings, std::string_view driver, const std::string& name,
                     const std::string& value) {
  const std::string said = std::string(driver) + ": " + name;
  if (name == "axes") {
    const auto axes = axes_from_text(value);
    if (!axes) {
      throw usage_error(said + " takes three of x, y, z, each once and with a sign or none, that make a " +
                        "right-handed frame, such as xz-y; found '" + value + "'");
    }
    settings.frame.device_from_maker = *axes;
    return true;
  }
  const auto* const known = std::find_if(kArmNumbers.begin(), kArmNumbers.end(),
                                         [&](const ArmNumber& each) { return each.name == name; });
  if (known == kArmNumbers.end()) return false;
  const auto parsed = number(value);
  if (!parsed) throw usage_error(said + " takes a number, found '" + value + "'");
  known->in(settings) = *parsed;
  if (!settings.valid()) throw usage_error(said + "=" + value + " is out of bounds");
  return true;
}

std::string arm_help(const ArmSettings& defaults, std::string_view axes) {
  const Vec3& middle = defaults.frame.middle;
  return "cap=N          largest force [N]; default " + short_number(defaults.force_cap) +
         "\nreach=N        half a side of the cube in which there is force [m]; default " +
         short_number(defaults.reach) +
         "\naxes=AXES      its axes that point right, up and towards you; default " + std::string(axes) +
         "\nmiddle_x=N     middle of its workspace in its own frame [m], and middle_y, middle_z; default " +
         short_number(middle.x) + ", " + short_number(middle.y) + ", " + short_number(middle.z) + "\n";
}

Vec3 force_within(const Vec3& force, double cap) noexcept {
  if (!is_finite(force)) return Vec3{0.0};
  // In units of the largest component: its square neither overflows nor vanishes.
  const double largest = std::max({std::abs(force.x), std::abs(force.y), std::abs(force.z)});
  const double length = largest > 0.0 ? largest * glm::length(force / largest) : 0.0;
  return length > cap ? force * (cap / length) : force;
}

}  // namespace palpate
