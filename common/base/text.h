/// Numbers and words in text: as users read them, and as options, tables and files hold them.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "common/base/error.h"
#include "common/base/index.h"

namespace palpate {

/// Six significant digits: "0.00123", "1.5e-07".
[[nodiscard]] std::string short_number(double value);
/// As few digits as give the same number back.
[[nodiscard]] std::string exact_number(double value);
/// The same in a cell of a table: "nan" where it is not finite.
[[nodiscard]] std::string csv_number(double value);
/// "2.7 MB"
[[nodiscard]] std::string bytes_text(std::uint64_t bytes);
/// "1 line", "3 lines"
[[nodiscard]] std::string counted(std::uint64_t count, const std::string& noun);

/// Of the "C" locale: a space, a tab, or an end of line, page or column.
[[nodiscard]] constexpr bool is_blank(char c) noexcept { return c == ' ' || (c >= '\t' && c <= '\r'); }
/// Without blanks and line ends around it.
[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;

/// The number that `text` is, blanks and a plus sign allowed; NaN and infinity are numbers too.
[[nodiscard]] std::optional<double> number(std::string_view text) noexcept;

/// The number of type T that all of `text` is, as std::from_chars() reads it: without blanks or a plus sign.
/// None where T does not hold it.
template <typename T>
[[nodiscard]] std::optional<T> parsed(std::string_view text) noexcept {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// With small letters in place of A to Z.
[[nodiscard]] std::string lowered(std::string_view text);

/// The parts between blanks and line ends, none of them empty.
[[nodiscard]] std::vector<std::string_view> words(std::string_view text);
/// The parts would outlive the text.
template <std::same_as<std::string> Text>
std::vector<std::string_view> words(Text&& text) = delete;

/// The parts between separators, empty ones included.
[[nodiscard]] std::vector<std::string_view> split(std::string_view text, char separator);
/// As of words().
template <std::same_as<std::string> Text>
std::vector<std::string_view> split(Text&& text, char separator) = delete;

/// Their opposite.
[[nodiscard]] std::string joined(const std::vector<std::string>& parts, std::string_view separator);

/// The index of `word`. @param what the words name: "colour". @throws Error (usage) that lists the known
/// ones.
template <std::size_t N>
[[nodiscard]] std::size_t find_word(const std::array<std::string_view, N>& words, std::string_view word,
                                    const char* what) {
  const auto found = std::find(words.begin(), words.end(), word);
  if (found != words.end()) return as_size(found - words.begin());
  std::string known;
  for (const std::string_view one : words) {
    if (!known.empty()) known += ", ";
    known += one;
  }
  throw usage_error("unknown " + std::string(what) + " '" + std::string(word) + "'; known are " + known);
}

/// Control characters as "\x1b": names in a file cannot move the cursor, or break a message into lines. Bytes
/// from 0x80 on stay as they are (UTF-8), and so do those of `kept`.
[[nodiscard]] std::string printable(std::string_view text, std::string_view kept = "");

/// `count` finite numbers separated by commas.
/// @throws Error (usage) that quotes `text` and says `grammar`.
[[nodiscard]] std::vector<double> parse_numbers(std::string_view text, std::size_t count,
                                                const std::string& grammar);

}  // namespace palpate
