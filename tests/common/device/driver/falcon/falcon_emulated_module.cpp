// A driver module for tests: the Falcon's driver on an emulated device in real time, in a hand that wanders.
// It is built beside the others, never installed, and chosen by its name: `--device falcon_emulated`. Its
// options are the Falcon's, `loaded=0` for one that needs its firmware, and `missing=1` for none at all.

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "common/device/driver/falcon/falcon_link.h"
#include "common/device/driver/transport/usb_module.h"
#include "tests/common/device/driver/falcon/falcon_emulator.h"
#include "tests/common/device/driver/transport/fake_usb.h"

namespace palpate::test {
namespace {

/// Moves the hand's target whenever the driver looks at the clock of the bus.
class WanderingFalcon final : public FakeDevice {
 public:
  explicit WanderingFalcon(const EmulatedFalcon& settings) : falcon_(settings) {}

  [[nodiscard]] UsbDevice description() const override { return falcon_.description(); }
  TransferStatus control(double now, const UsbControl& setup, std::span<const std::uint8_t> data) override {
    return falcon_.control(local(now), setup, data);
  }
  void write(double now, std::uint8_t endpoint, std::span<const std::uint8_t> data) override {
    falcon_.write(local(now), endpoint, data);
  }
  std::size_t read(double now, std::uint8_t endpoint, std::span<std::uint8_t> data) override {
    return falcon_.read(local(now), endpoint, data);
  }

 private:
  /// Time of the emulated device begins when it is first spoken to.
  double local(double now) {
    if (start_ < 0.0) start_ = now;
    const double t = now - start_;
    const auto wave = [t](double period) { return std::sin(2.0 * std::numbers::pi * t / period); };
    falcon_.set_target(FalconEmulator::kMiddle + 0.03 * Vec3{wave(3.0), wave(4.1), wave(5.3)});
    return t;
  }

  FalconEmulator falcon_;
  double start_ = -1.0;
};

DriverModule* emulated_module(std::string& /*error*/) noexcept {
  auto bus = std::make_unique<FakeUsb>(FakeUsb::Clock::kSystem);
  static FakeUsb& plugged = *bus;
  static LinkModule module = usb_module(
      std::move(bus),
      [](UsbTransport& transport, const DriverOptions& options) {
        EmulatedFalcon emulated{.loaded = true};
        DriverOptions others;
        bool missing = false;
        for (const auto& option : options) {
          if (option.first == "loaded") {
            emulated.loaded = option.second != "0";
          } else if (option.first == "missing") {
            missing = option.second == "1";
          } else {
            others.push_back(option);
          }
        }
        if (!missing) plugged.plug("1-2", std::make_shared<WanderingFalcon>(emulated));
        return std::make_unique<FalconLink>(transport, falcon_settings(others));
      },
      falcon_help());
  return &module;
}

}  // namespace
}  // namespace palpate::test

extern "C" [[gnu::visibility("default")]] const palpate::DriverEntry palpate_driver_entry;
const palpate::DriverEntry palpate_driver_entry{palpate::driver_build(), palpate::test::emulated_module};
