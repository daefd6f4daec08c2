/// Rows of tables that dtmri writes.
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace palpate {

/// Adds a comma and the shortest text that reads back as the same number.
template <typename T>
void add_number(std::string& row, T value) {
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  (row += ',').append(buffer.data(), result.ptr);
}

}  // namespace palpate
