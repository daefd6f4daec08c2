/// The module of the Pinch Glove. A serial line tells nobody what is at its end, so it finds none by itself.
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "common/device/driver/pinch_link.h"
#include "common/device/driver/serial_line.h"

namespace palpate {
namespace {

class PinchModule final : public DriverModule {
 public:
  [[nodiscard]] std::string help() const override { return pinch_help(); }
  std::unique_ptr<DriverLink> make_link(const DriverOptions& options, std::string& error) noexcept override {
    try {
      const PinchSettings settings = pinch_settings(options);
      return std::make_unique<PinchLink>(std::make_unique<SerialLine>(settings.port, settings.baud));
    } catch (const std::exception& problem) {
      error = problem.what();
      return nullptr;
    }
  }
  std::vector<FoundDevice> find(std::string& /*error*/) noexcept override { return {}; }
};

DriverModule* pinch_module(std::string& /*error*/) noexcept {
  static PinchModule module;
  return &module;
}

}  // namespace
}  // namespace palpate

extern "C" [[gnu::visibility("default")]] const palpate::DriverEntry palpate_driver_entry;
const palpate::DriverEntry palpate_driver_entry{palpate::driver_build(), palpate::pinch_module};
