/// Walls at the limits: stiffer than passive, slow and fast loops, late and coarse ones; each with what guards it, and without.
#pragma once

#include <vector>

#include "lab/data/stability.h"

namespace palpate {

/// A row of the stability table, and what the same wall comes to once its guard is taken out.
struct WallExtreme {
  StabilityCase held;
  double unguarded = 0.0;  ///< in the unit of `held`
};

/// Two kinds of guard. The passivity controller holds walls of ten to a thousand times the bound: how far the arm travels.
/// The bound itself holds those that come late, where the controller sees the energy too late: whether the arm goes on
/// swinging at 0.95 of the bound, and at a hundred times. Takes less than a second.
[[nodiscard]] std::vector<WallExtreme> wall_extremes();

}  // namespace palpate
