/// Error against run time of every constraint, with the iterations of its budget swept, on features that are
/// known in closed form. (constraint_sweep.h does the same for streamlines of the data at hand.)
///
/// A made hand goes along the feature and is pulled off it, with tremor, and with jumps within reach. With p
/// the proxy, q where it would be with unlimited work, and k the stiffness, a step has
///
///   residual   distance of p from the feature          force error   k |p - q|                        (1)
///
/// Both come of formulas and searches that the constraints have no part in. A constraint is one entry in
/// constraint_budget_subjects.cpp.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/haptics/constraint.h"
#include "lab/data/sweep.h"
#include "lab/hand/streamline_run.h"
#include "lab/page/section.h"

namespace palpate {

/// Where the proxy of a probe would be with unlimited work; remembers the probes before, as constraints do.
using IdealProxy = std::function<Vec3(const Vec3& probe)>;

/// With which nothing lets go, and all is caught.
[[nodiscard]] ChainSettings budget_settings();

/// A constraint to sweep. Workspace frame.
struct BudgetSubject {
  std::string name;  ///< "isosurface"
  ChainSettings settings = budget_settings();
  std::function<std::unique_ptr<Constraint>()> make;  ///< with its settings applied
  std::function<IdealProxy()> make_ideal;
  std::function<double(const Vec3&)> off_feature;  ///< distance from the feature [m]; null: nothing to be off
  std::function<Vec3(double)> guide;  ///< where the hand goes, by time [s]; on the feature at time 0
};

/// All constraints.
[[nodiscard]] std::vector<BudgetSubject> budget_subjects();

/// One constraint with one budget.
struct BudgetRow {
  std::string constraint;
  int iterations = 0;
  StepErrors residual;     ///< [m]
  StepErrors force_error;  ///< [N]
  double us_p50 = 0.0, us_p99 = 0.0, us_max = 0.0;
  int used = 0;  ///< most iterations that a step used
  std::size_t steps = 0, fallbacks = 0;
};

struct ConstraintBudget {
  std::vector<BudgetRow> rows;  ///< by constraint, small budgets first; those without a search have one row
  double clock_microseconds = 0.0;  ///< that reading the clock costs, in every time above
};

/// @throws Cancelled.
[[nodiscard]] ConstraintBudget run_constraint_budget(Effort effort, Progress* progress);

[[nodiscard]] ReportSection constraint_budget_section(const ConstraintBudget& budget);

}  // namespace palpate
