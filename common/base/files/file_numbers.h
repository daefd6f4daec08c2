/// Numbers in the bytes of a file, of either byte order.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace palpate {

/// The number at byte `at`. @pre at + sizeof(T) <= bytes.size().
template <typename T>
[[nodiscard]] T number_at(std::string_view bytes, std::size_t at, bool big_endian) noexcept {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), bytes.data() + at, sizeof(T));
  if (big_endian != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

}  // namespace palpate
