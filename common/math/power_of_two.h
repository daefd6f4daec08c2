/// Power-of-two units: multiplying by them is exact, so a data set scaled by 2^k gives the same bits.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace palpate {

/// The exponent k with 2^k <= |x| < 2^(k+1); 0 for zero, infinite or NaN `x`.
[[nodiscard]] inline int binary_exponent(double x) noexcept {
  return (x == 0.0 || !std::isfinite(x)) ? 0 : std::ilogb(x);
}

/// 2^k, exact; subnormal, zero or infinite where k leaves [-1022, 1023].
[[nodiscard]] inline double power_of_two(int k) noexcept {
  constexpr int kBias = 1023;
  if (k < -1022 || k > 1023) return std::ldexp(1.0, k);
  return std::bit_cast<double>(static_cast<std::uint64_t>(k + kBias) << 52);
}

}  // namespace palpate
