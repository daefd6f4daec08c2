/// The module of devices at a VRPN server.
#include <memory>
#include <string>

#include "common/device/driver/link_module.h"
#include "common/device/driver/transport/tcp_place.h"
#include "common/device/driver/vrpn/vrpn_link.h"

namespace palpate {
namespace {

DriverModule* vrpn_module(std::string& /*error*/) noexcept {
  static LinkModule module(
      [](const DriverOptions& options) {
        const VrpnSettings settings = vrpn_settings(options);
        return std::make_unique<VrpnLink>(
            std::make_unique<TcpPlace>(settings.address.host, settings.address.port), settings);
      },
      vrpn_help());
  return &module;
}

}  // namespace
}  // namespace palpate

extern "C" [[gnu::visibility("default")]] const palpate::DriverEntry palpate_driver_entry;
const palpate::DriverEntry palpate_driver_entry{palpate::driver_build(), palpate::vrpn_module};
