/// The options of `--device falcon:NAME=VALUE,…`.
#pragma once

#include <string>

#include "common/device/driver/falcon/falcon_link.h"
#include "common/device/driver_link.h"

namespace palpate {

/// Reads the image of the firmware, where one is named.
/// @throws Error (usage) for an unknown name or a value out of bounds, (bad input) for a file that cannot be
/// an image.
[[nodiscard]] FalconSettings falcon_settings(const DriverOptions& options);
[[nodiscard]] std::string falcon_help();

}  // namespace palpate
