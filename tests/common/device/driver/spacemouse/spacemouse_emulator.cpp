#include "tests/common/device/driver/spacemouse/spacemouse_emulator.h"

#include <algorithm>

namespace palpate::test {

UsbDevice SpaceMouseEmulator::description() const {
  // A second interface without reports, and an endpoint number that no driver should take for granted.
  return {.id = id_,
          .path = {},
          .endpoints = {{.interface = 0, .address = 0x02, .packet = 8, .interrupt = true},
                        {.interface = 0, .address = 0x83, .packet = 16, .interrupt = true}}};
}

TransferStatus SpaceMouseEmulator::control(double, const UsbControl& setup,
                                           std::span<const std::uint8_t> data) {
  const bool is_light = setup.request_type == 0x21 && setup.request == 0x09 && setup.value == 0x0204 &&
                        setup.index == 0 && data.size() == 2 && data[0] == 4;
  if (!is_light) {
    ++bad_controls_;
    return TransferStatus::kStall;
  }
  light_ = data[1];
  return TransferStatus::kOk;
}

std::size_t SpaceMouseEmulator::read(double now, std::uint8_t endpoint, std::span<std::uint8_t> data) {
  if (endpoint != 0x83) return 0;
  const bool deflected = std::any_of(raw_.begin(), raw_.end(), [](std::int16_t r) { return r != 0; });
  if (said_.empty() && now >= next_ && (deflected || moving_)) {
    next_ = now + 0.008;
    if (deflected || !forgets_rest_) {
      const auto numbers = [this](std::uint8_t id, std::size_t first, std::size_t count) {
        std::vector<std::uint8_t> report{id};
        for (std::size_t i = first; i < first + count; ++i) {
          const auto bits = static_cast<std::uint16_t>(raw_[i]);
          report.push_back(static_cast<std::uint8_t>(bits % 256));
          report.push_back(static_cast<std::uint8_t>(bits / 256));
        }
        return report;
      };
      if (together_) {
        said_.push_back(numbers(1, 0, 6));
      } else {
        said_.push_back(numbers(1, 0, 3));
        said_.push_back(numbers(2, 3, 3));
      }
    }
    moving_ = deflected;
  }
  if (said_.empty() && pressed_) {
    std::vector<std::uint8_t> report{3};
    for (int i = 0; i < 6; ++i) report.push_back(static_cast<std::uint8_t>(bitmap_ >> (8 * i)));
    said_.push_back(report);
    pressed_ = false;
  }
  if (said_.empty()) return 0;
  const std::size_t bytes = std::min(said_.front().size(), data.size());
  std::copy_n(said_.front().begin(), bytes, data.begin());
  said_.pop_front();
  return bytes;
}

}  // namespace palpate::test
