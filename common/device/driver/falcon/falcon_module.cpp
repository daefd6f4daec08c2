/// The module of the Novint Falcon.
#include <memory>
#include <string>

#include "common/device/driver/falcon/falcon_link.h"
#include "common/device/driver/transport/libusb_transport.h"
#include "common/device/driver/transport/usb_module.h"

namespace palpate {
namespace {

DriverModule* falcon_module(std::string& error) noexcept {
  std::unique_ptr<UsbTransport> bus = make_libusb_transport(error);
  if (!bus) return nullptr;
  static LinkModule module = usb_module(
      std::move(bus),
      [](UsbTransport& transport, const DriverOptions& options) {
        return std::make_unique<FalconLink>(transport, falcon_settings(options));
      },
      falcon_help());
  return &module;
}

}  // namespace
}  // namespace palpate

extern "C" [[gnu::visibility("default")]] const palpate::DriverEntry palpate_driver_entry;
const palpate::DriverEntry palpate_driver_entry{palpate::driver_build(), palpate::falcon_module};
