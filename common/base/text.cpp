#include "common/base/text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace palpate {
namespace {

constexpr std::string_view kBlank = " \t\r\n\v\f";

}  // namespace

std::string short_number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

std::string exact_number(double value) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() ? std::string(text.data(), end) : short_number(value);
}

std::string csv_number(double value) { return std::isfinite(value) ? exact_number(value) : "nan"; }

std::string bytes_text(std::uint64_t bytes) {
  constexpr std::array<const char*, 5> kUnits{"B", "kB", "MB", "GB", "TB"};
  double value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= 1000.0 && unit + 1 < kUnits.size(); ++unit) value /= 1000.0;
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), unit == 0 ? "%.0f %s" : "%.1f %s", value, kUnits[unit]);
  return text.data();
}

std::string counted(std::uint64_t count, const std::string& noun) {
  constexpr std::string_view kGreek = "hedron";
  if (count != 1 && noun.ends_with(kGreek))
    return std::to_string(count) + " " + noun.substr(0, noun.size() - 2) + "a";
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string_view trimmed(std::string_view text) noexcept {
  const auto first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::optional<double> number(std::string_view text) noexcept {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  return parsed<double>(text);
}

std::string lowered(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> parts;
  for (auto first = text.find_first_not_of(kBlank); first != std::string_view::npos;) {
    const auto end = std::min(text.find_first_of(kBlank, first), text.size());
    parts.push_back(text.substr(first, end - first));
    first = text.find_first_not_of(kBlank, end);
  }
  return parts;
}

std::string joined(const std::vector<std::string>& parts, std::string_view separator) {
  std::string text;
  for (const std::string& part : parts) {
    if (&part != &parts.front()) text += separator;
    text += part;
  }
  return text;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t start = 0;;) {
    const auto end = text.find(separator, start);
    parts.push_back(text.substr(start, end - start));
    if (end == std::string_view::npos) return parts;
    start = end + 1;
  }
}

std::string printable(std::string_view text, std::string_view kept) {
  static constexpr std::string_view kDigits = "0123456789abcdef";
  std::string shown;
  shown.reserve(text.size());
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool control = byte < 0x20U || byte == 0x7fU;
    if (!control || kept.find(c) != std::string_view::npos) {
      shown += c;
    } else {
      shown += "\\x";
      shown += kDigits[byte >> 4U];
      shown += kDigits[byte & 15U];
    }
  }
  return shown;
}

std::vector<double> parse_numbers(std::string_view text, std::size_t count, const std::string& grammar) {
  std::vector<double> numbers;
  for (const auto part : split(text, ',')) {
    const auto value = number(part);
    if (!value || !std::isfinite(*value)) {
      throw usage_error("'" + std::string(trimmed(part)) + "' is no finite number; " + grammar);
    }
    numbers.push_back(*value);
  }
  if (numbers.size() != count) {
    throw usage_error("'" + std::string(text) + "' has " + std::to_string(numbers.size()) +
                      " numbers, need " + std::to_string(count) + "; " + grammar);
  }
  return numbers;
}

}  // namespace palpate
