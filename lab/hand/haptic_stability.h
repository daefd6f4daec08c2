/// The rows of the stability table that are about the hand: what the streamline constraint and the safety
/// stage promise, on paths that no hand would take.
///
/// They run on the data at hand, on a made sink (a critical point), and on made data with a hole of NaNs. The
/// paths are rough (probe_paths.h), with rows of NaN and infinity, time that stands still and runs backwards.
#pragma once

#include <memory>
#include <vector>

#include "common/base/progress.h"
#include "common/field/vector_field.h"
#include "lab/data/stability.h"
#include "lab/hand/constraint/constraint_sweep.h"

namespace palpate {

/// What is promised of a proxy's distance from its line, in diagonals.
inline constexpr double kResidualLimit = 1e-6;

/// @param sweep says how far proxies were from independent lines.
/// @param request data at hand, for scaling it; only made data is scaled where it has no blocks.
/// @throws Cancelled.
[[nodiscard]] std::vector<StabilityCase> run_haptic_stability(const std::shared_ptr<const VectorField>& field,
                                                              const ConstraintSweep& sweep,
                                                              const StabilityRequest& request,
                                                              Progress* progress);

}  // namespace palpate
