/// Looking on a bus for the first device of a driver that can be opened.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/device/driver/transport/usb.h"
#include "common/device/driver_link.h"

namespace palpate {

/// [s] that a link without a device waits for one to be plugged in before it looks again.
inline constexpr double kLookPause = 0.25;

struct UsbFound {
  std::unique_ptr<UsbConnection> connection;  ///< null: there is none, or none that can be opened
  UsbDevice device;
  UsbEndpoint endpoint;  ///< the one towards the host that was asked for; its interface is claimed
  TransferStatus refused = TransferStatus::kOk;  ///< why one that is there cannot be opened; kOk: none is
};

/// Opens the first device of `driver` (usb_search.h) by the interface of its first endpoint towards the
/// host, interrupt or bulk: of several interfaces that one has the data, others set devices up. One that
/// cannot be opened is passed over: there may be another.
[[nodiscard]] UsbFound open_first(UsbTransport& transport, std::string_view driver, bool interrupt);

/// The same for a link that has no device: where there is none it waits for one to be plugged in. Phase and
/// counts of `status` follow: absent or refused, or one more opened and loading.
[[nodiscard]] UsbFound look_for(UsbTransport& transport, std::string_view driver, bool interrupt,
                                LinkStatus& status) noexcept;

/// What a user is to do about a device, "the SpaceMouse", that is there and cannot be opened.
[[nodiscard]] std::string refusal_advice(std::string_view device, TransferStatus refused);

// USB devices that this suite knows by their ids: what they are, and which driver is for them.

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
