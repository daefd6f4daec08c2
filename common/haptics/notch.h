/// The hold of a place that catches softly: a stiffness factor that fades with the stretch.
///
///   kappa(d) = (1 - (d/w)^2)^2 for |d| < w, else 0
///
/// The pull k kappa d is that of a potential; it is zero at the place and at both ends, with a continuous
/// slope there, and at most 0.29 k w: what is caught or let go by it feels no jump.
#pragma once

namespace palpate {

/// @param d stretch  @param w reach, in the same unit, > 0.
[[nodiscard]] constexpr double notch_hold(double d, double w) noexcept {
  const double part = d / w, rest = 1.0 - part * part;
  return rest > 0.0 ? rest * rest : 0.0;
}

}  // namespace palpate
