#include "common/device/driver/pedal/pedal_report.h"

#include <cstddef>

namespace palpate {
namespace {

constexpr std::uint32_t kLeft = 1, kMiddle = 2, kRight = 4, kAll = 7;

std::optional<std::uint32_t> of_keyboard(std::span<const std::uint8_t> report) noexcept {
  constexpr std::size_t kLength = 8, kKeys = 2;
  constexpr std::uint8_t kFirstKey = 0x04, kKeyB = 0x05, kKeyC = 0x06;  // below: rollover and other errors
  if (report.size() != kLength || report[1] != 0) return std::nullopt;
  std::uint32_t pedals = report[0] != 0 ? kLeft : 0;
  for (const std::uint8_t key : report.subspan(kKeys)) {
    if (key == 0) continue;
    if (key < kFirstKey) return std::nullopt;
    pedals |= key == kKeyB ? kMiddle : key == kKeyC ? kRight : kLeft;
  }
  return pedals;
}

}  // namespace

std::optional<std::uint32_t> pedals_of(PedalFormat format, std::span<const std::uint8_t> report) noexcept {
  switch (format) {
    case PedalFormat::kXKeys: {
      if (report.size() < 3 || report[0] != 0 || report[1] != 1) return std::nullopt;
      const std::uint32_t pedals = static_cast<std::uint32_t>(report[2]) >> 1U;
      return (report[2] & 1U) == 0 && pedals <= kAll ? std::optional(pedals) : std::nullopt;
    }
    case PedalFormat::kInfinity:
      return report.size() == 2 && report[0] <= kAll && report[1] == 0
                 ? std::optional<std::uint32_t>(report[0])
                 : std::nullopt;
    case PedalFormat::kKeyboard:
      return of_keyboard(report);
  }
  return std::nullopt;
}

}  // namespace palpate
