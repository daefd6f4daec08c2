/// Fading without a jump or a corner.
#pragma once

namespace palpate {

/// 0 up to u = 0, 1 from u = 1 on, and u^2 (3 - 2 u) between: its slope is continuous and at most 3/2.
[[nodiscard]] constexpr double fade(double u) noexcept {
  if (!(u > 0.0)) return 0.0;
  return u < 1.0 ? u * u * (3.0 - 2.0 * u) : 1.0;
}

}  // namespace palpate
