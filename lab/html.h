/// Bits of HTML that the sections of the page share.
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "lab/plot.h"

namespace palpate {

/// A table's cell; numbers stand at the right, text at the left.
[[nodiscard]] inline std::string cell(const std::string& text, bool is_text = false) {
  return std::string(is_text ? "<td class=\"text\">" : "<td>") + escaped(text) + "</td>";
}

/// Three significant digits, whole numbers from 1000 to a million: "0.0197", "1.5e-07", "1183".
[[nodiscard]] inline std::string three_digits(double value) {
  if (!std::isfinite(value)) return "none";
  const double size = std::abs(value);
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), size >= 999.5 && size < 1e6 ? "%.0f" : "%.3g", value);
  return text.data();
}

[[nodiscard]] inline std::string paragraph(const std::string& text, const char* css = nullptr) {
  return std::string("<p") + (css ? " class=\"" + std::string(css) + "\"" : "") + ">" + escaped(text) +
         "</p>\n";
}

}  // namespace palpate
