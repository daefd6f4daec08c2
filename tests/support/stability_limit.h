/// Where a simulated wall begins to swing.
#pragma once

#include <cmath>

namespace palpate::test {

/// The right-hand side of (1) of lab/wall_run.h in closed form [N/m]. @pre damping and mass above zero.
inline double linear_stability_limit(double mass, double damping, double rate) {
  const double e = damping / (mass * rate), rise = -std::expm1(-e);
  return damping * damping / mass * rise / (rise - std::exp(-e) * e);
}

}  // namespace palpate::test
