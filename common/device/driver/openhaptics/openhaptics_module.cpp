/// The module of devices that OpenHaptics works. Its library is opened when a link is asked for.
#include <memory>
#include <string>

#include "common/device/driver/link_module.h"
#include "common/device/driver/openhaptics/hd_link.h"

namespace palpate {
namespace {

DriverModule* hd_module(std::string& /*error*/) noexcept {
  static SystemLinkClock clock;
  static LinkModule module(
      [](const DriverOptions& options) {
        const HdSettings settings = hd_settings(options);
        return std::make_unique<HdLink>(open_hd_library(settings.file), clock, settings);
      },
      hd_help());
  return &module;
}

}  // namespace
}  // namespace palpate

extern "C" [[gnu::visibility("default")]] const palpate::DriverEntry palpate_driver_entry;
const palpate::DriverEntry palpate_driver_entry{palpate::driver_build(), palpate::hd_module};
