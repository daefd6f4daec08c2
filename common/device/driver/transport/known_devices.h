/// USB devices that this suite knows by their ids: what they are, and which driver is for them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/device/driver/transport/usb.h"
#include "common/device/driver_link.h"

namespace palpate {

struct KnownDevice {
  UsbId id;
  std::string_view name;
  std::string_view driver;  ///< for `--device`; empty: there is none yet
  std::string_view note;    ///< what the user should know of one that is plugged in
};

/// Null for a device that is not known.
[[nodiscard]] const KnownDevice* find_known(UsbId id) noexcept;
/// What is plugged in and known, with what stands in the way of using it.
[[nodiscard]] std::vector<FoundDevice> find_devices(UsbTransport& transport);

}  // namespace palpate
