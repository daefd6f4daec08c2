/// The module of foot switches.
#include <memory>
#include <string>

#include "common/device/driver/pedal/pedal_link.h"
#include "common/device/driver/transport/libusb_transport.h"
#include "common/device/driver/transport/usb_module.h"

namespace palpate {
namespace {

DriverModule* pedal_module(std::string& error) noexcept {
  std::unique_ptr<UsbTransport> bus = make_libusb_transport(error);
  if (!bus) return nullptr;
  static LinkModule module = usb_module(
      std::move(bus),
      [](UsbTransport& transport, const DriverOptions& options) {
        expect_no_options("pedal", options);
        return std::make_unique<PedalLink>(transport);
      },
      "");
  return &module;
}

}  // namespace
}  // namespace palpate

extern "C" [[gnu::visibility("default")]] const palpate::DriverEntry palpate_driver_entry;
const palpate::DriverEntry palpate_driver_entry{palpate::driver_build(), palpate::pedal_module};
