/// Counts and positions as indices.
#pragma once

#include <cstddef>
#include <type_traits>

namespace palpate {

/// Whole numbers and enumerators.
template <typename T>
concept Countable = std::is_integral_v<T> || std::is_enum_v<T>;

/// `value` as the index or the size that it is. @pre value >= 0. @rt Safe.
template <Countable T>
[[nodiscard, gnu::always_inline]] constexpr std::size_t as_size(T value) noexcept {
  return static_cast<std::size_t>(value);
}

}  // namespace palpate
