/// Numbers as programs write them in text.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/text.h"

namespace palpate {

/// The number that `text` is, beside the usual way as Fortran writes it ("1.0D+00", and "1.0-100" where the letter
/// found no place), as Windows does ("1.#QNAN", "-1.#IND", "1.#INF"), and smaller than a double holds (0).
[[nodiscard]] inline std::optional<double> written_number(std::string_view text) {
  if (const auto value = number(text)) return value;
  constexpr std::size_t kLongest = 64;
  text = trimmed(text);
  if (text.empty() || text.size() > kLongest) return std::nullopt;
  const bool negative = text.front() == '-';
  if (const std::size_t mark = text.find("1.#"); mark <= 1 && mark != std::string_view::npos) {
    const std::string word = lowered(text.substr(mark + 3));
    if (word.find("nan") != std::string::npos || word.starts_with("ind"))
      return std::numeric_limits<double>::quiet_NaN();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return word.starts_with("inf") ? std::optional(negative ? -kInfinity : kInfinity) : std::nullopt;
  }
  std::string plain(text);
  for (char& c : plain) {
    if (c == 'd' || c == 'D') c = 'e';
  }
  if (plain.find_first_of("eE") == std::string::npos) {
    const std::size_t sign = plain.find_first_of("+-", 1);
    if (sign != std::string::npos) plain.insert(sign, "e");
  }
  if (const auto value = number(plain)) return value;
  // Digits and a negative exponent: too small.
  const std::size_t exponent = plain.find_first_of("eE");
  if (exponent == std::string::npos || plain.find_first_not_of("0123456789+-.eE") != std::string::npos)
    return std::nullopt;
  const auto digits = number(plain.substr(0, exponent));
  const auto power = number(plain.substr(exponent + 1));
  if (!digits || !power || *power > -300.0) return std::nullopt;
  return negative ? -0.0 : 0.0;
}

}  // namespace palpate
