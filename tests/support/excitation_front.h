/// The front of a wave of excitation in closed form.
#pragma once

#include <cmath>

#include "common/field/analytic/excitation.h"

namespace palpate::test {

/// c and w of (4) of common/field/analytic/excitation.h.
inline double front_speed(const ExcitableTissue& tissue, double diffusivity) {
  return std::sqrt(tissue.rate * diffusivity / (2.0 * tissue.time_unit)) * (1.0 - 2.0 * tissue.threshold);
}
inline double front_width(const ExcitableTissue& tissue, double diffusivity) {
  return std::sqrt(2.0 * diffusivity * tissue.time_unit / tissue.rate);
}

}  // namespace palpate::test
