/// The module of the Pinch Glove. A serial line tells nobody what is at its end, so it finds none by itself.
#include <memory>
#include <string>

#include "common/device/driver/link_module.h"
#include "common/device/driver/pinchglove/pinch_link.h"
#include "common/device/driver/transport/serial_line.h"

namespace palpate {
namespace {

DriverModule* pinch_module(std::string& /*error*/) noexcept {
  static LinkModule module(
      [](const DriverOptions& options) {
        const PinchSettings settings = pinch_settings(options);
        return std::make_unique<PinchLink>(std::make_unique<SerialLine>(settings.port, settings.baud));
      },
      pinch_help());
  return &module;
}

}  // namespace
}  // namespace palpate

extern "C" [[gnu::visibility("default")]] const palpate::DriverEntry palpate_driver_entry;
const palpate::DriverEntry palpate_driver_entry{palpate::driver_build(), palpate::pinch_module};
