/// Walls at the limits: stiffer than passive, slow and fast loops, late and coarse ones; each with what guards it, and without.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace palpate {

struct WallExtreme {
  std::string name, builder, claim;
  std::string guard;                            ///< what holds it
  double limit = 0.0;                           ///< [mm]
  std::function<double(bool guarded)> measure;  ///< [mm]
};

/// Two kinds of guard. The passivity controller holds walls of ten to a thousand times the bound: how far the arm travels.
/// The bound itself holds those that come late, where the controller sees the energy too late: whether the arm goes on
/// swinging at 0.95 of the bound, and at a hundred times. All take less than a second together.
[[nodiscard]] std::vector<WallExtreme> wall_extremes();

}  // namespace palpate
