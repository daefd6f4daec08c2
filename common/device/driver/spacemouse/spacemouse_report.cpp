#include "common/device/driver/spacemouse/spacemouse_report.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>

namespace palpate {
namespace {

constexpr std::uint8_t kPushReport = 1, kTurnReport = 2, kButtonReport = 3;
constexpr std::size_t kThreeNumbers = 7, kSixNumbers = 13;

void take_numbers(std::span<const std::uint8_t> bytes, std::span<std::int16_t> numbers) noexcept {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = static_cast<std::int16_t>(bytes[2 * i] | (bytes[2 * i + 1] << 8U));
  }
}

}  // namespace

SpaceMouseNews take_report(std::span<const std::uint8_t> report, SpaceMouseState& state) noexcept {
  if (report.empty()) return SpaceMouseNews::kNothing;
  const std::span<std::int16_t> raw(state.raw);
  switch (report[0]) {
    case kPushReport:
      if (report.size() < kThreeNumbers) return SpaceMouseNews::kNothing;
      take_numbers(report.subspan(1), report.size() >= kSixNumbers ? raw : raw.first(3));
      return SpaceMouseNews::kAxes;
    case kTurnReport:
      if (report.size() < kThreeNumbers) return SpaceMouseNews::kNothing;
      take_numbers(report.subspan(1), raw.last(3));
      return SpaceMouseNews::kAxes;
    case kButtonReport:
      if (report.size() < 2) return SpaceMouseNews::kNothing;
      state.buttons = 0;
      for (std::size_t i = 0; i < std::min<std::size_t>(report.size() - 1, 4); ++i) {
        state.buttons |= static_cast<std::uint32_t>(report[1 + i]) << (8 * i);
      }
      return SpaceMouseNews::kButtons;
    default:
      return SpaceMouseNews::kNothing;
  }
}

std::array<double, DeviceAtoms::kValuators> valuators_of(
    const SpaceMouseState& state, const std::array<double, DeviceAtoms::kValuators>& signs) noexcept {
  const auto part = [&](std::size_t i) {
    const int raw = state.raw[i];
    return std::abs(raw) <= kSpaceMouseRest ? 0.0 : std::clamp(raw / kSpaceMouseFull, -1.0, 1.0);
  };
  // The device's y points towards the user, its z down.
  return {signs[0] * part(0), -signs[1] * part(2), signs[2] * part(1),
          signs[3] * part(3), -signs[4] * part(5), signs[5] * part(4)};
}

}  // namespace palpate
