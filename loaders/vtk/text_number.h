/// Words of a text file as the numbers that VTK's readers (operator>> of a C++ stream) would take them for.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace palpate {

/// The number that all of `word` is: a plus sign may precede it, NaN and infinity are numbers. Too small for
/// `T` is zero; too large for it is none, the stream would stop there.
template <typename T>
[[nodiscard]] std::optional<T> real_number(std::string_view word) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || word.empty()) return std::nullopt;
  if (error == std::errc()) return value;
  if (error != std::errc::result_out_of_range) return std::nullopt;
  if (std::abs(std::strtold(std::string(word).c_str(), nullptr)) >= 1.0L) return std::nullopt;
  return T{0};
}

/// The same for whole numbers of `bits` bits, with a sign or without.
[[nodiscard]] inline std::optional<std::int64_t> whole_number(std::string_view word, unsigned bits,
                                                              bool with_sign) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
  const char* const last = word.data() + word.size();
  if (!with_sign && bits == 64) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), last, value);
    if (error != std::errc() || end != last) return std::nullopt;
    constexpr std::uint64_t kMost = std::numeric_limits<std::int64_t>::max();
    return static_cast<std::int64_t>(value < kMost ? value : kMost);
  }
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), last, value);
  if (error != std::errc() || end != last) return std::nullopt;
  if (bits == 64) return value;
  const std::int64_t most = (std::int64_t{1} << (with_sign ? bits - 1 : bits)) - 1;
  return value > most || value < (with_sign ? -most - 1 : 0) ? std::nullopt : std::optional(value);
}

}  // namespace palpate
