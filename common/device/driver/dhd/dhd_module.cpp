/// The module of Force Dimension's devices. Their library is opened when a link is asked for.
#include <memory>
#include <string>

#include "common/device/driver/dhd/dhd_link.h"
#include "common/device/driver/link_module.h"

namespace palpate {
namespace {

DriverModule* dhd_module(std::string& /*error*/) noexcept {
  static SystemLinkClock clock;
  static LinkModule module(
      [](const DriverOptions& options) {
        const DhdSettings settings = dhd_settings(options);
        return std::make_unique<DhdLink>(open_dhd_library(settings.file), clock, settings);
      },
      dhd_help());
  return &module;
}

}  // namespace
}  // namespace palpate

extern "C" [[gnu::visibility("default")]] const palpate::DriverEntry palpate_driver_entry;
const palpate::DriverEntry palpate_driver_entry{palpate::driver_build(), palpate::dhd_module};
