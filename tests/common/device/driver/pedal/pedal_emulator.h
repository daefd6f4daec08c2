/// A foot switch at the wire, as a HID device that speaks when something changes, repeats itself if it is
/// told to (SET_IDLE) and answers GET_REPORT, each of both only if it can. It codes its reports by itself.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "tests/common/device/driver/transport/fake_usb.h"

namespace palpate::test {

struct EmulatedPedal {
  UsbId id{0x0c45, 0x7403};  ///< 05f3:042c an XK-3, 05f3:00ff a VEC, all others keyboards
  bool repeats = true;
  bool answers = true;
};

class PedalEmulator final : public FakeDevice {
 public:
  explicit PedalEmulator(const EmulatedPedal& settings = {}) : settings_(settings) {}

  /// Bit i: pedal i from the left is down.
  void press(unsigned pedals) {
    changed_ = changed_ || pedals != pedals_;
    pedals_ = pedals;
  }
  /// Any bytes, as the next report.
  void say(std::vector<std::uint8_t> report) { said_.push_back(std::move(report)); }
  /// It hangs: no report and no answer, though it is still plugged in.
  void hang(bool on) { hangs_ = on; }

  [[nodiscard]] double idle() const { return idle_; }  ///< [s] between two reports; 0: on change
  [[nodiscard]] int asked() const { return asked_; }

  UsbDevice description() const override;
  TransferStatus control(double now, const UsbControl& setup, std::span<const std::uint8_t> data) override;
  std::size_t answer(double now, const UsbControl& setup, std::span<std::uint8_t> data) override;
  void write(double, std::uint8_t, std::span<const std::uint8_t>) override {}
  std::size_t read(double now, std::uint8_t endpoint, std::span<std::uint8_t> data) override;

 private:
  [[nodiscard]] std::vector<std::uint8_t> report() const;

  EmulatedPedal settings_;
  unsigned pedals_ = 0;
  bool changed_ = false, hangs_ = false;
  double idle_ = 0.0, next_ = 0.0;
  std::deque<std::vector<std::uint8_t>> said_;
  int asked_ = 0;
};

}  // namespace palpate::test
