#include "common/cli/simulated_option.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "common/base/error.h"

namespace palpate {

namespace {

int button_of(std::string_view text, const std::string& device) {
  int button = DeviceLimits::kNoButton;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), button);
  if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size() || button < 0 ||
      button >= DeviceLimits::kButtons) {
    throw usage_error("--device " + device + ": a button from 0 to 31 is expected, found '" +
                      std::string(text) + "'");
  }
  return button;
}

}  // namespace

std::optional<SimulatedDeviceOptions> simulated_option(const std::string& device) {
  constexpr std::string_view kName = "simulated", kHand = "hand=", kButton = "button=";
  std::string_view rest = device;
  if (!rest.starts_with(kName)) return std::nullopt;
  rest.remove_prefix(kName.size());
  if (!rest.empty() && rest.front() != ':') return std::nullopt;
  SimulatedDeviceOptions simulated{.profile = device_profiles().front()};
  bool named = false, held = false, enabled = false;
  while (!rest.empty()) {
    rest.remove_prefix(1);  // ':' or ','
    const std::string_view item = rest.substr(0, rest.find(','));
    rest.remove_prefix(item.size());
    bool& given = item.starts_with(kHand) ? held : item.starts_with(kButton) ? enabled : named;
    if (given) throw usage_error("--device " + device + ": one device, one hand and one button at most");
    given = true;
    if (item.starts_with(kHand)) {
      simulated.hand = find_hand(item.substr(kHand.size()));
    } else if (item.starts_with(kButton)) {
      simulated.limits.enabling_button = button_of(item.substr(kButton.size()), device);
    } else {
      simulated.profile = find_profile(item);
    }
  }
  return simulated;
}

DeviceLimits simulated_limits(const SimulatedDeviceOptions& device, const DeviceLimits& asked) {
  DeviceLimits limits = safe_limits(device.profile);
  limits.force_cap = std::min(limits.force_cap, asked.force_cap);
  limits.slew_cap = std::min(limits.slew_cap, asked.slew_cap);
  limits.reach_lower = Vec3{-HUGE_VAL};
  limits.reach_upper = Vec3{HUGE_VAL};
  limits.enabling_button = device.limits.enabling_button;
  return limits;
}

std::string device_key(const SimulatedDeviceOptions& device) {
  return "simulated:" + std::string(device.profile.name);
}

std::string title_of(const SimulatedDeviceOptions& device) {
  return std::string(device.profile.title) + " in a " + (device.hand == kFirmHand ? "firm" : "relaxed") +
         " hand";
}

}  // namespace palpate
