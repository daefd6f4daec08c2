/// Settings of a walk by a general method.
#pragma once

#include <cmath>

namespace palpate {

/// Frame L.
struct WalkSettings {
  double tolerance = 1e-6;      ///< local error per arc length
  double fixed_step = 0.0;      ///< of Euler and RK4
  double rest_distance = 1e-6;  ///< how near a fixed point counts as having reached it
  double largest_step = HUGE_VAL;
};

}  // namespace palpate
