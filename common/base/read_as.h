/// Numbers among bytes.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>

namespace palpate {

/// Number `index` of those of type T that `bytes` are, which need no alignment. @pre it is there.
template <typename T>
[[nodiscard]] T read_as(std::span<const std::byte> bytes, std::size_t index) noexcept {
  T value;
  std::memcpy(&value, bytes.data() + index * sizeof(T), sizeof(T));
  return value;
}

}  // namespace palpate
