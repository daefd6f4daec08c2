/// Looking on a bus for the first device of a driver that can be opened.
#pragma once

#include <memory>
#include <string_view>

#include "common/device/driver/usb.h"

namespace palpate {

/// [s] that a link without a device waits for one to be plugged in before it looks again.
inline constexpr double kLookPause = 0.25;

struct UsbFound {
  std::unique_ptr<UsbConnection> connection;  ///< null: there is none, or none that can be opened
  UsbDevice device;
  UsbEndpoint endpoint;  ///< the one towards the host that was asked for; its interface is claimed
  TransferStatus refused = TransferStatus::kOk;  ///< why one that is there cannot be opened; kOk: none is
};

/// Opens the first device of `driver` (known_devices.h) by the interface of its first endpoint towards the
/// host, interrupt or bulk: of several interfaces that one has the data, others set devices up. One that
/// cannot be opened is passed over: there may be another.
[[nodiscard]] UsbFound open_first(UsbTransport& transport, std::string_view driver, bool interrupt);

}  // namespace palpate
