#include "common/device/driver/dataglove/dataglove_report.h"

#include <algorithm>

namespace palpate {

std::optional<std::array<double, kGloveNumbers>> glove_numbers(
    std::span<const std::uint8_t> report) noexcept {
  constexpr std::size_t kReport = 64;
  constexpr unsigned kFull = 4096;
  if (report.size() != kReport) return std::nullopt;
  std::array<double, kGloveNumbers> numbers{};
  for (std::size_t i = 0; i < kGloveNumbers; ++i) {
    const unsigned raw = static_cast<unsigned>(report[2 * i]) << 8U | report[2 * i + 1];
    if (raw > kFull) return std::nullopt;
    numbers[i] = static_cast<double>(raw) / kFull;
  }
  return numbers;
}

double BendRange::bend(double part) noexcept {
  const double before = before_ < 0.0 ? part : before_;
  before_ = part;
  lower_ = std::min(lower_, std::max(before, part));
  upper_ = std::max(upper_, std::min(before, part));
  if (!(upper_ - lower_ >= kLeast)) return 0.0;
  return std::clamp((part - lower_) / (upper_ - lower_), 0.0, 1.0);
}

}  // namespace palpate
