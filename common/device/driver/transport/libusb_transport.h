/// The bus of this machine, through libusb. Part of driver modules alone.
#pragma once

#include <memory>
#include <string>

#include "common/device/driver/transport/usb.h"

namespace palpate {

/// Null, with `error` in one line, where libusb cannot start.
[[nodiscard]] std::unique_ptr<UsbTransport> make_libusb_transport(std::string& error);

}  // namespace palpate
