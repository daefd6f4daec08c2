/// How stiff a spring feels beside a force across it, and what makes up for that (Ikits 2006, eq. 6.11).
///
///   F = F_1 + F_2,   F_1 across F_2,   |F_2| = k_2 e_2
///   d|F| / d e_2 = (|F_2| / |F|) k_2                                                                     (6.11)
///
/// so that a spring feels the softer, the more presses across it: a groove in a wall, friction under pressure. The
/// stiffness k' for which it feels as stiff as k_2 does alone follows from (|F_2'| / |F'|) k' = k_2 with |F_2'| = k' e_2 and
/// rho = |F_1| / (k_2 e_2):
///
///   k' = k_2 sqrt((1 + sqrt(1 + 4 rho^2)) / 2)                                                           (1)
///
/// It grows without bound where the spring is at rest, as sqrt(rho): what a device bears is its bound.
#pragma once

#include <algorithm>
#include <cmath>

namespace palpate {

/// (6.11) [N/m]. @param k2 k_2 [N/m]  @param along |F_2| [N]  @param across |F_1| [N], both >= 0. k2 where there is no force at all.
[[nodiscard]] inline double perceived_stiffness(double k2, double along, double across) noexcept {
  const double all = std::hypot(along, across);
  return all > 0.0 ? k2 * (along / all) : k2;
}

/// k' / k_2 of (1), `most` at most. @param along k_2 e_2, the force of the spring as it is [N]  @param most >= 1
[[nodiscard]] inline double stiffness_compensation(double along, double across, double most) noexcept {
  if (!(across > 0.0)) return 1.0;
  if (!(along > 0.0)) return most;
  const double rho = across / along;
  return std::min(most, std::sqrt(0.5 * (1.0 + std::sqrt(1.0 + 4.0 * rho * rho))));
}

}  // namespace palpate
