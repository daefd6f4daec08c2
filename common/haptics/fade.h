/// Fading without a jump or a corner.
#pragma once

namespace palpate {

/// 0 up to u = 0, 1 from u = 1 on, and u^2 (3 - 2 u) between: its slope is continuous and at most 3/2.
[[nodiscard]] constexpr double fade(double u) noexcept {
  if (!(u > 0.0)) return 0.0;
  return u < 1.0 ? u * u * (3.0 - 2.0 * u) : 1.0;
}

// The hold of a place that catches softly: a stiffness factor that fades with the stretch.
//
//   kappa(d) = (1 - (d/w)^2)^2 for |d| < w, else 0
//
// The pull k kappa d is that of a potential; it is zero at the place and at both ends, with a continuous
// slope there, and at most 0.29 k w: what is caught or let go by it feels no jump.

/// @param d stretch  @param w reach, in the same unit, > 0.
[[nodiscard]] constexpr double notch_hold(double d, double w) noexcept {
  const double part = d / w, rest = 1.0 - part * part;
  return rest > 0.0 ? rest * rest : 0.0;
}

}  // namespace palpate
