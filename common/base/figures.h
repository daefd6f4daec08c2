/// Measured figures as tables show them.
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

namespace palpate {

/// Three significant digits, whole numbers from 1000 to a million: "0.0197", "1.5e-07", "1183".
[[nodiscard]] inline std::string three_digits(double value) {
  if (!std::isfinite(value)) return "none";
  const double size = std::abs(value);
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), size >= 999.5 && size < 1e6 ? "%.0f" : "%.3g", value);
  return text.data();
}

}  // namespace palpate
