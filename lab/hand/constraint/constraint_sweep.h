/// Error against run time of the streamline constraint's update, with its budget swept.
///
/// Probe paths (probe_paths.h) begin at seeds of the scene at hand. Each catch of a line gives a reference
/// (reference_curve.h) that the code under test has no part in: the line through the place of the catch, and
/// on it the local minimum of the distance, followed without any limit of work. With p the proxy, q that
/// minimum, c(.) the reference and k the stiffness, a step has
///
///   residual     min_s |p - c(s)|        lag   |arc of p - arc of q|        force error   k |p - q| (1)
///
/// Times are processor time of the thread, with what reading the clock costs.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/base/work_precision.h"
#include "common/haptics/constraint.h"
#include "lab/data/sweep.h"
#include "lab/hand/probe_paths.h"
#include "lab/hand/streamline_run.h"

namespace palpate {

/// One kind of path with one budget.
struct ConstraintRow {
  PathKind path = PathKind::kSmooth;
  bool cells_swept = false;  ///< which of the two numbers of the budget this row's sweep changes
  UpdateBudget budget;
  StepErrors residual;     ///< [diagonals]
  StepErrors lag;          ///< [diagonals]
  StepErrors force_error;  ///< [N]
  double us_mean = 0.0, us_p50 = 0.0, us_p99 = 0.0, us_max = 0.0;
  std::size_t steps = 0;
  std::size_t compared = 0;  ///< steps that follow a line which the reference knows
  std::size_t releases = 0, fallbacks = 0;

  [[nodiscard]] std::string parameter() const;  ///< "iterations=4"
};

struct ConstraintSweep {
  std::string subject;              ///< "carotid.vtk, vectors"
  std::vector<ConstraintRow> rows;  ///< by path and swept number, small to large
  double release_force = 0.0;  ///< [N] of a line that is about to let go: what a force error compares with
  double clock_microseconds = 0.0;  ///< that reading the clock costs, in every time above
  std::size_t seeds = 0;
};

struct ConstraintSweepRequest {
  std::string subject;
  std::vector<Vec3> seeds;  ///< of good lines, data coordinates; the effort says how many are taken
  Effort effort = Effort::kNormal;
  int threads = 1;
};

/// @throws Cancelled.
[[nodiscard]] ConstraintSweep run_constraint_sweep(const std::shared_ptr<const VectorField>& field,
                                                   const ConstraintSweepRequest& request, Progress* progress);

/// The rows as report.json has them; their seconds are what 99 % of the steps stay below.
[[nodiscard]] std::vector<WorkPrecision> work_precision_rows(const ConstraintSweep& sweep);

}  // namespace palpate
