/// Units as FileInfo::units states them: "coordinates in mm, vm in mV, times in ms".
#pragma once

#include <string>
#include <string_view>

namespace palpate {

/// Of "coordinates", "values", "times", or of an array by its name; empty: not stated.
[[nodiscard]] inline std::string stated_unit(std::string_view units, std::string_view of) {
  const std::string words = std::string(of) + " in ";
  for (std::size_t begin = 0; begin < units.size();) {
    const std::size_t end = units.find(", ", begin);
    const std::string_view part = units.substr(begin, end == std::string_view::npos ? end : end - begin);
    if (part.starts_with(words)) return std::string(part.substr(words.size()));
    if (end == std::string_view::npos) break;
    begin = end + 2;
  }
  return {};
}

}  // namespace palpate
