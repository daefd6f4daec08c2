/// `--device` at a workbench: what workbench.toml adds to what was typed.
#pragma once

#include <functional>
#include <string>

#include "common/device/driver_library.h"
#include "common/kinematics/workbench_file.h"

namespace palpate {

/// The device that `text` names, with the options that the workbench has for it and that the text does not
/// name, and the workbench's dead-man switch where the text names none.
/// @throws Error (usage) as parse_device() does.
[[nodiscard]] DeviceText device_at_workbench(const std::string& text, const WorkbenchGeometry& workbench);

/// What workbench.toml knows it by: its driver, and what tells it from others of that driver where it is
/// asked for so, "dhd:1234".
[[nodiscard]] std::string device_key(const DeviceText& device);

/// Opens it with the workbench's calibration (calibrated_link.h): [arm] of an arm that tells its joints,
/// [tracker] and [stylus] of a tracker.
/// @param note told in a sentence where an [arm] is not of this device.
/// @throws Error as open_device() does.
[[nodiscard]] OpenedDevice open_at_workbench(const DeviceText& device, const WorkbenchGeometry& workbench,
                                             const std::function<void(const std::string&)>& note);

/// Whether two texts name one device, so that it is opened once: the same driver and options, or the first
/// one has no options. @throws Error (usage) as parse_device() does.
[[nodiscard]] bool is_same_device(const std::string& text, const std::string& opened);

}  // namespace palpate
