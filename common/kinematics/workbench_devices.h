/// What workbench.toml knows of devices in the hand, each by the name that `--device` has for it.
///
///   [device.falcon]    # what its driver is told, as --device falcon:NAME=VALUE,… does: gains and geometry
///   gain = 3620        #   as a calibration finds them; what the command line says comes first
///   thigh = 0.0603
///
///   [tuned.falcon]     # what it bears; the verb `tune` writes it
///   stiffness = 950    # [N/m] the most that explorers show on it
///   rate = 1000        # [Hz] of the servo that it was found with
///   places = [[x, y, z, stiffness], …]     # [m] frame of the device, and where each began to swing [N/m]
///
/// A simulated arm is `[tuned."simulated:falcon"]`, by its class. Of several devices of one driver each is
/// told by what it is asked for with: `[tuned."dhd:1234"]` of `--device dhd:serial=1234`, or the `name`,
/// `device`, `port` or address of other drivers. What stands there comes before what stands under the
/// driver's name.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

/// The options of a driver, as text.
struct DeviceOptions {
  std::string device;  ///< "falcon"
  std::vector<std::pair<std::string, std::string>> options;
};

struct TunedPlace {
  Vec3 place{0.0};         ///< [m] frame of the device
  double stiffness = 0.0;  ///< the stiffest that did not swing there [N/m]
};

struct TunedDevice {
  std::string device;
  double stiffness = 0.0;  ///< [N/m] > 0
  double rate = 1000.0;    ///< [Hz] > 0
  std::vector<TunedPlace> places;
};

/// Of a device by its name and by what it is told from others by, "dhd:1234", else of its driver. Null where
/// nothing is known of it.
[[nodiscard]] const TunedDevice* find_tuned(const std::vector<TunedDevice>& all, std::string_view device);

/// `given`, and before it those options that the file has for this device, then for its driver, each that is
/// not named before.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> with_device_options(
    const std::vector<DeviceOptions>& all, std::string_view device,
    const std::vector<std::pair<std::string, std::string>>& given);

/// The section, with its header.
[[nodiscard]] std::string section_text(const TunedDevice& tuned);

}  // namespace palpate
