/// Opens driver modules by name, and only when they are asked for: a program without a device maps none.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/device/driver_link.h"

namespace palpate {

/// Drivers that this version has, each a module of that name.
[[nodiscard]] const std::vector<std::string>& driver_names();

/// The module lib/palpate/palpate_driver_NAME.so; never closed.
/// @throws Error (usage) where there is none of that name, (work failed) where it cannot start: the line says
/// which package is missing, or that it is of another build.
[[nodiscard]] DriverModule& open_driver(const std::string& name);

/// A device as the command line names it: `NAME[:OPTION=VALUE[,OPTION=VALUE…]]`.
struct DeviceText {
  std::string name;
  DriverOptions options;
};
/// @throws Error (usage) for an option without a name.
[[nodiscard]] DeviceText parse_device(std::string_view text);

/// The link to a device of the command line. @throws Error as above, and what the driver says.
[[nodiscard]] std::unique_ptr<DriverLink> open_link(const std::string& device);

}  // namespace palpate
