// A driver module for tests: the driver of the Polhemus trackers on an emulated Liberty in real time. It is
// built beside the others, never installed, and chosen by its name: `--device polhemus_emulated`. Its options
// are the driver's, `still=1` for sensors that do not move, and `metal=1` for metal near them.

#include <memory>
#include <string>
#include <utility>

#include "common/base/error.h"
#include "common/device/driver/polhemus/polhemus_link.h"
#include "common/device/driver/transport/usb_module.h"
#include "tests/common/device/driver/polhemus/polhemus_emulator.h"
#include "tests/common/device/driver/transport/fake_usb.h"

namespace palpate::test {
namespace {

DriverModule* emulated_tracker(std::string& /*error*/) noexcept {
  auto bus = std::make_unique<FakeUsb>(FakeUsb::Clock::kSystem);
  static FakeUsb& plugged = *bus;
  static LinkModule module = usb_module(
      std::move(bus),
      [](UsbTransport& transport, const DriverOptions& options) {
        // As a real one would be busy.
        static bool opened = false;
        if (std::exchange(opened, true)) throw usage_error("the tracker is opened twice");
        const auto tracker = std::make_shared<PolhemusEmulator>();
        DriverOptions others;
        for (const auto& option : options) {
          if (option.first == "still") {
            tracker->freeze(option.second == "1");
          } else if (option.first == "metal") {
            tracker->distort(option.second == "1");
          } else {
            others.push_back(option);
          }
        }
        plugged.plug("1-3", std::make_shared<PolhemusOnUsb>(UsbId{0x0f44, 0xff20}, tracker));
        const PolhemusSettings settings = polhemus_settings(others);
        return std::make_unique<PolhemusLink>(polhemus_port(settings, transport), settings);
      },
      polhemus_help());
  return &module;
}

}  // namespace
}  // namespace palpate::test

extern "C" [[gnu::visibility("default")]] const palpate::DriverEntry palpate_driver_entry;
const palpate::DriverEntry palpate_driver_entry{palpate::driver_build(), palpate::test::emulated_tracker};
