/// What chains give the hand on closed loops, with both forms of their force (haptics/chain_force.h).
///
/// A hand is led around smooth random loops next to where the features of a chain cross, several turns each
/// and both ways round. With F the force of the chain and x the hand,
///
///   W = integral of F . dx over a turn      E = max of sum_i k/2 |p_i - p_(i-1)|^2 on it             (1)
///
/// W > 0 is energy that the chain has made out of nothing: the hand could go round again and gather more. A
/// spring gives 0, friction takes. The constraints are those that hands feel, on features known in closed
/// form; W is summed by the rule of trapezoids over steps of micrometres.
#pragma once

#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/haptics/chain_force.h"
#include "lab/data/stability.h"
#include "lab/data/sweep.h"
#include "lab/page/section.h"

namespace palpate {

struct ChainWorkRow {
  std::string chain;   ///< "line, then sphere"
  double angle = 0.0;  ///< [degrees] between line and surface normal, where it is swept; else 0
  ChainForceForm form = ChainForceForm::kSum;
  double yield = 0.0;     ///< most of W / E over all turns
  double taken = 0.0;     ///< most of -W / E
  double steepest = 0.0;  ///< largest |dF| / |dx| between steps without a jump of a feature [N/m]
  double us_mean = 0.0;   ///< of a step, processor time
  int turns = 0;
};

struct ChainWork {
  std::vector<ChainWorkRow> rows;  ///< both forms of a chain after each other
};

/// What is promised of the form that hands feel: yield at most.
inline constexpr double kYieldLimit = 1e-3;

/// @throws Cancelled.
[[nodiscard]] ChainWork run_chain_work(Effort effort, Progress* progress);

[[nodiscard]] ReportSection chain_work_section(const ChainWork& work);
/// The rows of the default form, as rows of the stability table.
[[nodiscard]] std::vector<StabilityCase> chain_work_cases(const ChainWork& work);

}  // namespace palpate
