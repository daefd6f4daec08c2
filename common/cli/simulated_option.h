/// `--device simulated[:ITEM[,ITEM…]]`: a simulated arm and hand in place of real ones. An item is the name
/// of a device class (device/device_profile.h), `hand=relaxed` or `hand=firm`, or `button=N`: there is force
/// only while button N, counted from 0, is held.
#pragma once

#include <optional>
#include <string>

#include "common/device/simulated_device.h"

namespace palpate {

/// Nothing for a device of another kind. Of its limits only the enabling button is set: see
/// simulated_limits().
/// @throws Error (usage) for an item that is not known, or two of a kind.
[[nodiscard]] std::optional<SimulatedDeviceOptions> simulated_option(const std::string& device);

/// The safe limits of its class (device/device_profile.h), caps no higher than those of `asked`. The reach is
/// left open: a simulated arm stands wherever the data is placed.
[[nodiscard]] DeviceLimits simulated_limits(const SimulatedDeviceOptions& device, const DeviceLimits& asked);

/// "simulated:falcon": what workbench.toml knows it by.
[[nodiscard]] std::string device_key(const SimulatedDeviceOptions& device);

/// "PHANToM Premium 3.0 class in a relaxed hand"
[[nodiscard]] std::string title_of(const SimulatedDeviceOptions& device);

}  // namespace palpate
