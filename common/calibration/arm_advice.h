/// Where an arm should be measured next, so that its parameters can be told apart.
#pragma once

#include <string>
#include <vector>

#include "common/calibration/arm_problem.h"

namespace palpate {

/// Tries further grids in planes through and beside the places measured so far, each with an unknown frame of
/// its own and twenty poses that the arm reaches with readings like those seen, and ranks them by the
/// condition number that all measurements would have together. Reproducible.
/// @param now the condition number without.
/// @return sentences, the best grid first; empty where no candidate helps.
[[nodiscard]] std::vector<std::string> where_to_measure_next(const std::vector<ArmMeasurement>& rows,
                                                             const ArmEstimate& estimate,
                                                             const std::vector<DhhPlace>& free, double now);

}  // namespace palpate
