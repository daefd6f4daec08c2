/// Opens driver modules by name, and only when they are asked for: a program without a device maps none.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/device/device_limits.h"
#include "common/device/driver_link.h"

namespace palpate {

/// Drivers that this version has, each a module of that name.
[[nodiscard]] const std::vector<std::string>& driver_names();

/// The module lib/palpate/palpate_driver_NAME.so; never closed.
/// @throws Error (usage) where there is none of that name, (work failed) where it cannot start: the line says
/// which package is missing, or that it is of another build.
[[nodiscard]] DriverModule& open_driver(const std::string& name);

/// A device as the command line names it: `NAME[:OPTION=VALUE[,OPTION=VALUE…]]`. An address with an @ stands
/// for the option `at`: `vrpn:Tracker0@lab`. Two options are nobody's
/// own, they say what the dead-man switch is: `button=N|none` and `enable=NAME`, another device.
struct DeviceText {
  std::string name;
  DriverOptions options;      ///< for the driver
  std::optional<int> button;  ///< DeviceLimits::kNoButton: `none`
  std::string enable;         ///< empty: the device itself
};
/// @throws Error (usage) for an option without a name or value, a button that is none, or a switch that is
/// named and not wanted.
[[nodiscard]] DeviceText parse_device(std::string_view text);
/// 0 to 31, or kNoButton for "none"; nothing for other texts.
[[nodiscard]] std::optional<int> enabling_button_of(std::string_view text) noexcept;

/// A device and its dead-man switch.
struct OpenedDevice {
  std::unique_ptr<DriverLink> link;
  EnablingSwitch enabling;  ///< as asked for, else as the driver's limits have it
};
/// Opens the modules that are needed. Another device's button is its first one where none is named.
/// @throws Error as above, and what the drivers say.
[[nodiscard]] OpenedDevice open_device(const DeviceText& device);

/// What holding the switch is: "while button 2 of the device is held"; empty where none is needed.
[[nodiscard]] std::string description_of(const EnablingSwitch& enabling, const DeviceText& device);

}  // namespace palpate
