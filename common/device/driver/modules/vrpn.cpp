/// The module of devices at a VRPN server.
#include <memory>
#include <string>

#include "common/device/driver/link_module.h"
#include "common/device/driver/tcp_place.h"
#include "common/device/driver/vrpn_link.h"

namespace palpate {
namespace {

/// A link, and the place that it is to.
class PlacedLink final : public DriverLink {
 public:
  explicit PlacedLink(const VrpnSettings& settings)
      : place_(settings.address.host, settings.address.port), link_(place_, settings) {}

  bool round(const Vec3& force) noexcept override { return link_.round(force); }
  [[nodiscard]] const DeviceAtoms& atoms() const noexcept override { return link_.atoms(); }
  [[nodiscard]] const LinkStatus& status() const noexcept override { return link_.status(); }
  [[nodiscard]] std::string advice() const override { return link_.advice(); }
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return link_.limits(); }
  [[nodiscard]] std::string place() const override { return link_.place(); }

 private:
  TcpPlace place_;
  VrpnLink link_;
};

DriverModule* vrpn_module(std::string& /*error*/) noexcept {
  static LinkModule module(
      [](const DriverOptions& options) { return std::make_unique<PlacedLink>(vrpn_settings(options)); },
      vrpn_help());
  return &module;
}

}  // namespace
}  // namespace palpate

extern "C" [[gnu::visibility("default")]] const palpate::DriverEntry palpate_driver_entry;
const palpate::DriverEntry palpate_driver_entry{palpate::driver_build(), palpate::vrpn_module};
