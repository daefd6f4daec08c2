/// Power-of-two units: multiplying by them is exact, so a data set scaled by 2^k gives the same bits.
#pragma once

#include <cmath>

namespace palpate {

/// The exponent k with 2^k <= |x| < 2^(k+1); 0 for zero, infinite or NaN `x`.
[[nodiscard]] inline int binary_exponent(double x) noexcept {
  return (x == 0.0 || !std::isfinite(x)) ? 0 : std::ilogb(x);
}

/// 2^k, exact. @pre -1022 <= k <= 1023.
[[nodiscard]] inline double power_of_two(int k) noexcept { return std::ldexp(1.0, k); }

}  // namespace palpate
