/// `--device` at a workbench: what workbench.toml adds to what was typed.
#pragma once

#include <string>

#include "common/calibration/workbench_file.h"
#include "common/device/driver_library.h"

namespace palpate {

/// The device that `text` names, with the options that the workbench has for it and that the text does not
/// name, and the workbench's dead-man switch where the text names none.
/// @throws Error (usage) as parse_device() does.
[[nodiscard]] DeviceText device_at_bench(const std::string& text, const WorkbenchGeometry& bench);

}  // namespace palpate
