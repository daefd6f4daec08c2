/// Sizes that a file claims: what does not fit in 64 bits stays the largest number instead of wrapping round.
#pragma once

#include <cstdint>

namespace palpate {

/// More than any file holds.
inline constexpr std::uint64_t kHuge = ~std::uint64_t{0};

/// a b, or kHuge.
[[nodiscard]] inline std::uint64_t times(std::uint64_t a, std::uint64_t b) noexcept {
  std::uint64_t product = 0;
  return __builtin_mul_overflow(a, b, &product) ? kHuge : product;
}

}  // namespace palpate
