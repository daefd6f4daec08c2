/// A force device described in a file, for sweeps of walls (`--model FILE.toml`).
///
///   title = "our arm"          # optional
///   mass = 0.2                 # [kg] apparent, at the tip
///   damping = 1.5              # [N s/m] of the arm itself
///   friction = 0.1             # [N] Coulomb; optional, as all below: 0
///   encoder_step = 3e-5        # [m] at the tip
///   sensor_delay = 0.001       # [s], and actuator_delay
///   peak_force = 10            # [N]; default 4
///   max_stiffness = 2000       # [N/m] that its maker states
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "common/device/device_profile.h"

namespace palpate {

struct DescribedDevice {
  std::string name, title;
  DeviceProfile profile;  ///< its names point into this
};

/// A class of devices by its name, or one from a file whose name ends with .toml.
/// @throws Error (usage) for an unknown class; (bad input) with the line of what is wrong.
[[nodiscard]] std::unique_ptr<const DescribedDevice> described_device(const std::string& model);

}  // namespace palpate
