#include "tests/common/device/driver/pedal/pedal_emulator.h"

#include <algorithm>

namespace palpate::test {

UsbDevice PedalEmulator::description() const {
  return {.id = settings_.id,
          .path = {},
          .endpoints = {{.interface = 0, .address = 0x81, .packet = 8, .interrupt = true},
                        {.interface = 1, .address = 0x82, .packet = 8, .interrupt = true}}};
}

std::vector<std::uint8_t> PedalEmulator::report() const {
  const bool left = pedals_ % 2 == 1, middle = pedals_ / 2 % 2 == 1, right = pedals_ / 4 % 2 == 1;
  if (settings_.id == UsbId{0x05f3, 0x042c}) {
    int bits = 0;
    if (left) bits += 2;
    if (middle) bits += 4;
    if (right) bits += 8;
    return {0x00, 0x01, static_cast<std::uint8_t>(bits), 0, 0, 0};
  }
  if (settings_.id == UsbId{0x05f3, 0x00ff}) return {static_cast<std::uint8_t>(pedals_), 0};
  std::vector<std::uint8_t> keys{0, 0};
  if (left) keys.push_back(0x04);    // a
  if (middle) keys.push_back(0x05);  // b
  if (right) keys.push_back(0x06);   // c
  keys.resize(8, 0);
  return keys;
}

TransferStatus PedalEmulator::control(double now, const UsbControl& setup,
                                      std::span<const std::uint8_t> data) {
  const bool is_idle = setup.request_type == 0x21 && setup.request == 0x0A && setup.value % 256 == 0 &&
                       setup.index == 0 && data.empty();
  if (!is_idle || !settings_.repeats) return TransferStatus::kStall;
  idle_ = 0.004 * (setup.value / 256);
  next_ = now;
  return TransferStatus::kOk;
}

std::size_t PedalEmulator::answer(double /*now*/, const UsbControl& setup, std::span<std::uint8_t> data) {
  ++asked_;
  const bool is_report = setup.request_type == 0xA1 && setup.request == 0x01 && setup.value == 0x0100;
  if (!is_report || !settings_.answers || hangs_) return 0;
  const std::vector<std::uint8_t> now = report();
  const std::size_t bytes = std::min(now.size(), data.size());
  std::copy_n(now.begin(), bytes, data.begin());
  return bytes;
}

std::size_t PedalEmulator::read(double now, std::uint8_t endpoint, std::span<std::uint8_t> data) {
  if (endpoint != 0x81 || hangs_) return 0;
  if (said_.empty() && (changed_ || (idle_ > 0.0 && now >= next_))) {
    said_.push_back(report());
    changed_ = false;
    next_ = now + idle_;
  }
  if (said_.empty()) return 0;
  const std::size_t bytes = std::min(said_.front().size(), data.size());
  std::copy_n(said_.front().begin(), bytes, data.begin());
  said_.pop_front();
  return bytes;
}

}  // namespace palpate::test
