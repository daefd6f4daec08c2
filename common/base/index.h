/// Counts and positions as indices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "common/base/check.h"

namespace palpate {

/// Whole numbers and enumerators.
template <typename T>
concept Countable = std::is_integral_v<T> || std::is_enum_v<T>;

/// `value` as the index or the size that it is. @pre value >= 0. @rt Safe.
template <Countable T>
[[nodiscard, gnu::always_inline]] constexpr std::size_t as_size(T value) noexcept {
  return static_cast<std::size_t>(value);
}

/// The whole part of `value` as an index. @pre 0 <= value < 2^53. @rt Safe.
[[nodiscard, gnu::always_inline]] inline std::size_t floor_size(double value) noexcept {
  PALPATE_ASSERT(value >= 0.0 && value < 0x1p53);
  return static_cast<std::size_t>(value);
}

/// Two numbers as one, whichever of them comes first.
[[nodiscard]] constexpr std::uint64_t pair_key(std::uint32_t a, std::uint32_t b) noexcept {
  return (std::uint64_t{a < b ? a : b} << 32U) | (a < b ? b : a);
}

}  // namespace palpate
