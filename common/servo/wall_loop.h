/// The loop that a device and a servo close, as the bounds on its stiffness see it (haptics/coupling.h).
#pragma once

#include "common/device/device_profile.h"
#include "common/haptics/coupling.h"

namespace palpate {

/// @param rate of the servo [Hz], above zero.
[[nodiscard]] inline WallLoop wall_loop(const DeviceProfile& device, double rate) noexcept {
  return {.damping = device.damping,
          .friction = device.friction,
          .encoder_step = device.encoder_step,
          .delay = device.sensor_delay + device.actuator_delay,
          .period = 1.0 / rate,
          .device_stiffness = device.max_stiffness};
}

}  // namespace palpate
