#include "common/app/cli/simulated_option.h"

#include <string_view>

#include "common/base/error.h"

namespace palpate {

std::optional<SimulatedDeviceOptions> simulated_option(const std::string& device) {
  constexpr std::string_view kName = "simulated", kHand = "hand=";
  std::string_view rest = device;
  if (!rest.starts_with(kName)) return std::nullopt;
  rest.remove_prefix(kName.size());
  if (!rest.empty() && rest.front() != ':') return std::nullopt;
  SimulatedDeviceOptions simulated{.profile = device_profiles().front()};
  bool named = false, held = false;
  while (!rest.empty()) {
    rest.remove_prefix(1);  // ':' or ','
    const std::string_view item = rest.substr(0, rest.find(','));
    rest.remove_prefix(item.size());
    const bool is_hand = item.starts_with(kHand);
    if (is_hand ? held : named) {
      throw usage_error("--device " + device + ": one device and one hand at most");
    }
    if (is_hand) {
      simulated.hand = find_hand(item.substr(kHand.size()));
    } else {
      simulated.profile = find_profile(item);
    }
    (is_hand ? held : named) = true;
  }
  return simulated;
}

std::string title_of(const SimulatedDeviceOptions& device) {
  return std::string(device.profile.title) + " in a " + (device.hand == kFirmHand ? "firm" : "relaxed") +
         " hand";
}

}  // namespace palpate
