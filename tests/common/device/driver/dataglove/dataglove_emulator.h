/// A 5DT Data Glove at the wire.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "tests/common/device/driver/transport/fake_usb.h"

namespace palpate::test {

/// A glove at the wire: 50 reports a second, each sensor between the limits of the hand that wears it.
class DataGloveEmulator final : public FakeDevice {
 public:
  explicit DataGloveEmulator(UsbId id) : id_(id) {}

  /// 0 stretched, 1 a fist, for each of the sixteen numbers.
  void bend(std::size_t sensor, double part) { bent_[sensor] = part; }
  void bend_all(double part) { bent_.fill(part); }
  void hang(bool on) { hangs_ = on; }
  void say(std::vector<std::uint8_t> report) { said_ = std::move(report); }

  UsbDevice description() const override {
    return {.id = id_,
            .path = {},
            .endpoints = {{.interface = 0, .address = 0x85, .packet = 64, .interrupt = true}}};
  }
  TransferStatus control(double, const UsbControl&, std::span<const std::uint8_t>) override {
    return TransferStatus::kStall;
  }
  void write(double, std::uint8_t, std::span<const std::uint8_t>) override {}
  std::size_t read(double now, std::uint8_t, std::span<std::uint8_t> data) override {
    if (hangs_ || (said_.empty() && now < next_)) return 0;
    std::vector<std::uint8_t> report = std::exchange(said_, {});
    if (report.empty()) {
      next_ = now + 0.02;
      for (const double part : bent_) {
        const int raw = 1000 + static_cast<int>(2000.0 * part);
        report.push_back(static_cast<std::uint8_t>(raw / 256));
        report.push_back(static_cast<std::uint8_t>(raw % 256));
      }
      report.resize(64, 0xAA);
    }
    const std::size_t bytes = std::min(report.size(), data.size());
    std::copy_n(report.begin(), bytes, data.begin());
    return bytes;
  }

 private:
  UsbId id_;
  std::array<double, 16> bent_{};
  std::vector<std::uint8_t> said_;
  double next_ = 0.0;
  bool hangs_ = false;
};

}  // namespace palpate::test
