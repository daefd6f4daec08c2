/// The face of a driver module over a bus, which lists what is plugged in.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "common/device/driver/link_module.h"
#include "common/device/driver/transport/usb.h"
#include "common/device/driver/transport/usb_search.h"

namespace palpate {

/// Makes a link on a bus from options. @throws Error.
using MakeUsbLink = std::function<std::unique_ptr<DriverLink>(UsbTransport&, const DriverOptions&)>;

/// @pre bus is there.
inline LinkModule usb_module(std::unique_ptr<UsbTransport> bus, MakeUsbLink make, std::string help) {
  const std::shared_ptr<UsbTransport> shared = std::move(bus);
  return {[shared, make = std::move(make)](const DriverOptions& options) { return make(*shared, options); },
          std::move(help), [shared] { return find_devices(*shared); }};
}

}  // namespace palpate
