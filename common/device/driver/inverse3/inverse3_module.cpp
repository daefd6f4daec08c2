/// The module of the Haply Inverse3. Only it has a WebSocket library in it.
#include <memory>
#include <string>

#include "common/device/driver/inverse3/inverse3_link.h"
#include "common/device/driver/link_module.h"
#include "common/device/driver/transport/web_transport.h"

namespace palpate {
namespace {

/// The devices of a service on this machine, if one answers.
std::vector<FoundDevice> find_inverse3(WebTransport& transport) {
  constexpr double kTime = 0.2;  // [s]
  const WebAddress service = Inverse3Settings().service;
  const WebOpened opened = transport.open(service, kTime);
  std::string message;
  HaplyState state;
  if (!opened.connection || opened.connection->receive(message, kTime) != TransferStatus::kOk ||
      !read_haply_state(message, "", state) || !state.device) {
    return {};
  }
  return {{.name = "Haply Inverse3",
           .id = std::string(state.device->view()),
           .place = service.host + ":" + std::to_string(service.port),
           .access = "ok",
           .driver = "inverse3",
           .note = ""}};
}

DriverModule* inverse3_module(std::string& error) noexcept {
  try {
    static const std::unique_ptr<WebTransport> transport = make_beast_transport();
    static LinkModule module(
        [](const DriverOptions& options) {
          return std::make_unique<Inverse3Link>(*transport, inverse3_settings(options));
        },
        inverse3_help(), [] { return find_inverse3(*transport); });
    return &module;
  } catch (const std::exception& problem) {
    error = problem.what();
    return nullptr;
  }
}

}  // namespace
}  // namespace palpate

extern "C" [[gnu::visibility("default")]] const palpate::DriverEntry palpate_driver_entry;
const palpate::DriverEntry palpate_driver_entry{palpate::driver_build(), palpate::inverse3_module};
