/// What the user says of a Polhemus tracker.
#pragma once

#include <memory>
#include <string>

#include "common/device/driver/polhemus/polhemus_port.h"
#include "common/device/driver_link.h"
#include "common/math/vec.h"

namespace palpate {

struct PolhemusSettings {
  /// The half of the room that sensors are in, seen from the transmitter: the tracker cannot tell a place
  /// from the one opposite.
  Vec3 hemisphere{1.0, 0.0, 0.0};
  std::string port;  ///< a serial line; empty: USB
  int baud = 115200;
  PolhemusFamily family = PolhemusFamily::kFastrak;  ///< at a serial line
};

/// The options of `--device polhemus:port=/dev/ttyUSB0,baud=115200,model=fastrak,hemisphere=+x`.
/// @throws Error (usage).
[[nodiscard]] PolhemusSettings polhemus_settings(const DriverOptions& options);
[[nodiscard]] std::string polhemus_help();
/// Where these settings say that it is. `transport` outlives it.
[[nodiscard]] std::unique_ptr<PolhemusPort> polhemus_port(const PolhemusSettings& settings,
                                                          UsbTransport& transport);

}  // namespace palpate
