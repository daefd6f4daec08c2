/// A SpaceMouse at the wire: reports in either layout while its cap is deflected, a last one at rest,
/// buttons, and its light.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "tests/common/device/driver/transport/fake_usb.h"

namespace palpate::test {

class SpaceMouseEmulator final : public FakeDevice {
 public:
  /// @param together all six axes in one report of 13 bytes, as wireless models send them.
  explicit SpaceMouseEmulator(UsbId id = {0x046d, 0xc626}, bool together = false)
      : id_(id), together_(together) {}

  /// Raw axes from now on; all zero: let go.
  void deflect(const std::array<std::int16_t, 6>& raw) { raw_ = raw; }
  /// The bitmap as it is sent, 6 bytes.
  void press(std::uint64_t bitmap) {
    bitmap_ = bitmap;
    pressed_ = true;
  }
  /// Any bytes, as the next report.
  void say(std::vector<std::uint8_t> report) { said_.push_back(std::move(report)); }
  /// The report that it is at rest never comes.
  void forget_rest(bool on) { forgets_rest_ = on; }

  [[nodiscard]] int light() const { return light_; }  ///< -1: never set
  [[nodiscard]] int bad_controls() const { return bad_controls_; }

  UsbDevice description() const override;
  TransferStatus control(double now, const UsbControl& setup, std::span<const std::uint8_t> data) override;
  void write(double, std::uint8_t, std::span<const std::uint8_t>) override {}
  std::size_t read(double now, std::uint8_t endpoint, std::span<std::uint8_t> data) override;

 private:
  UsbId id_;
  bool together_;
  std::array<std::int16_t, 6> raw_{};
  bool moving_ = false, pressed_ = false, forgets_rest_ = false;
  std::uint64_t bitmap_ = 0;
  double next_ = 0.0;  ///< [s] of the next report of axes
  std::deque<std::vector<std::uint8_t>> said_;
  int light_ = -1, bad_controls_ = 0;
};

}  // namespace palpate::test
