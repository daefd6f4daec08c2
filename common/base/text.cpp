#include "common/base/text.h"

#include <array>
#include <charconv>
#include <cstdio>

namespace palpate {

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

}  // namespace palpate
