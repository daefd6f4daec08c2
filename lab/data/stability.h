/// The data at hand put to the extremes: what was measured and what is promised. Made cases, whose true answer is known, stand
/// in the catalogue (lab/extremes). The scene's own data is traced with the method that lines of this scene use by default.
#pragma once

#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/base/work_precision.h"
#include "common/field/data_set.h"
#include "common/trace/trace.h"

namespace palpate {

struct StabilityRequest {
  std::vector<DataSet> blocks;  ///< the data at hand, arrays of the field alone; empty: no case
  VectorChoice choice;
  std::string file;
  std::vector<Vec3> seeds;
  TraceOptions trace;  ///< limits and tolerance of the lines of this scene
};

/// @throws Cancelled. A case that cannot be set up on this data is left out.
[[nodiscard]] std::vector<StabilityCase> run_stability(const StabilityRequest& request, Progress* progress);

}  // namespace palpate
