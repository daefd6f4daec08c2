/// `--device simulated[:ITEM[,ITEM]]`: a simulated arm and hand in place of real ones. An item is the name of
/// a device class (device/device_profile.h), or `hand=relaxed` or `hand=firm`.
#pragma once

#include <optional>
#include <string>

#include "common/device/simulated_device.h"

namespace palpate {

/// Nothing for a device of another kind. Limits and path are left for the caller to set.
/// @throws Error (usage) for an item that is not known, or two of a kind.
[[nodiscard]] std::optional<SimulatedDeviceOptions> simulated_option(const std::string& device);

/// "PHANToM Premium 3.0 class in a relaxed hand"
[[nodiscard]] std::string title_of(const SimulatedDeviceOptions& device);

}  // namespace palpate
