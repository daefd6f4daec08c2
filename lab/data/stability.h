/// The first stability table: extreme cases, what was measured and what is promised.
///
/// Four cases are made up, so that the true answer is known; the others alter the data at hand. The scene's
/// own data is traced with the method that lines of this scene use by default.
#pragma once

#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/base/work_precision.h"
#include "common/field/data_set.h"
#include "common/trace/trace.h"

namespace palpate {

struct StabilityRequest {
  std::vector<DataSet> blocks;  ///< the data at hand, arrays of the field alone; empty: only the made cases
  VectorChoice choice;
  std::string file;
  std::vector<Vec3> seeds;
  TraceOptions trace;  ///< limits and tolerance of the lines of this scene
};

/// @throws Cancelled. A case that cannot be set up on this data is left out.
[[nodiscard]] std::vector<StabilityCase> run_stability(const StabilityRequest& request, Progress* progress);

}  // namespace palpate
