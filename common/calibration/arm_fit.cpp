#include "common/calibration/arm_fit.h"

#include <algorithm>
#include <cmath>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/text.h"
#include "common/calibration/arm_advice.h"
#include "common/calibration/point_alignment.h"

namespace palpate {
namespace {

std::size_t grid_count(const std::vector<ArmMeasurement>& rows) {
  int most = 0;
  for (const ArmMeasurement& row : rows) most = std::max(most, row.grid);
  return static_cast<std::size_t>(most) + 1;
}

/// Where grids are, if the arm were as `chain` says. @throws Error for a grid without enough points.
std::vector<Rigid> first_grids(const std::vector<ArmMeasurement>& rows, const DhhChain& chain,
                               std::size_t count, const std::string& source) {
  std::vector<Rigid> out(1);
  for (std::size_t g = 1; g < count; ++g) {
    std::vector<Vec3> put, tips;
    for (const ArmMeasurement& row : rows) {
      if (row.grid != static_cast<int>(g)) continue;
      put.push_back(row.point);
      tips.push_back(chain.forward(row.readings).translation);
    }
    const auto aligned = align_points(put, tips);
    if (!aligned)
      throw input_error({.file = source,
                         .place = "grid " + std::to_string(g),
                         .found = counted(put.size(), "point") + " that span no plane",
                         .expected = "three points that are not on a line, at least",
                         .remedy = "measure more points of that grid"});
    out.push_back(aligned->to_from_from);
  }
  return out;
}

struct Fitted {
  ArmEstimate estimate;
  LeastSquaresProblem problem;
  LeastSquaresSummary summary;
};

Fitted fit(const std::vector<ArmMeasurement>& rows, const DhhChain& chain, const std::vector<Rigid>& grids,
           const std::vector<DhhPlace>& free, const ArmFitOptions& options) {
  Fitted out;
  out.problem = arm_problem(rows, chain, grids, free);
  out.summary = minimize(out.problem, {.loss = options.loss, .loss_scale = options.loss_scale});
  out.estimate = arm_estimate(out.problem, chain, grids.size(), free);
  return out;
}

double error_of(const ArmEstimate& e, const ArmMeasurement& row) {
  return glm::distance(e.grids[static_cast<std::size_t>(row.grid)] * row.point,
                       e.chain.forward(row.readings).translation);
}

std::vector<double> errors_of(const ArmEstimate& e, const std::vector<ArmMeasurement>& rows) {
  std::vector<double> out;
  for (const ArmMeasurement& row : rows) out.push_back(error_of(e, row));
  return out;
}

}  // namespace

ArmFit calibrate_arm(const MeasurementTable<ArmMeasurement>& table, const DhhChain& nominal,
                     const ArmFitOptions& options) {
  const Stopwatch watch;
  const std::vector<ArmMeasurement>& rows = table.rows;
  const std::vector<DhhPlace> free =
      options.offsets_only ? offset_parameters(nominal) : full_parameters(nominal);
  const std::size_t grids = grid_count(rows), unknowns = free.size() + 6 * (grids - 1);
  // Without a third of freedom to spare nothing can be left out for validation.
  if (2 * rows.size() <= unknowns)
    throw input_error(
        {.file = table.source,
         .place = "",
         .found = counted(rows.size(), "measurement") + " for " + std::to_string(unknowns) + " unknowns",
         .expected = "more than " + std::to_string(unknowns / 2),
         .remedy = options.offsets_only ? "measure more points"
                                        : "measure more points, or estimate the joints' offsets alone"});

  ArmFit out;
  FitReport& report = out.report;
  report.kind = "arm";
  report.source = table.source;
  report.measurements = rows.size();
  const std::vector<Rigid> start = first_grids(rows, nominal, grids, table.source);
  // Only of the first grid is it known where it is before anything is fitted.
  std::vector<ArmMeasurement> first;
  for (const ArmMeasurement& row : rows) {
    if (row.grid == 0) first.push_back(row);
  }
  report.errors.push_back(distance_row("nominal", false, errors_of({nominal, start}, first)));
  const auto judge = [&](const std::string& method, const std::vector<DhhPlace>& places,
                         const Fitted& whole) {
    report.errors.push_back(distance_row(method, false, errors_of(whole.estimate, rows)));
    report.errors.push_back(distance_row(
        method, true,
        left_out_errors(
            rows, options.folds,
            [&](const std::vector<ArmMeasurement>& kept) {
              return fit(kept, whole.estimate.chain, whole.estimate.grids, places, options).estimate;
            },
            error_of)));
  };
  const std::vector<DhhPlace> offsets = offset_parameters(nominal);
  Fitted best = fit(rows, nominal, start, offsets, options);
  judge("offsets", offsets, best);
  if (!options.offsets_only) {
    best = fit(rows, best.estimate.chain, best.estimate.grids, free, options);
  }
  report.iterations = best.summary.iterations;
  out.chain = best.estimate.chain;
  out.grids = best.estimate.grids;

  const Linearization linear = linearize(best.problem);
  const Identifiability found = analyze(linear);
  describe(report, found);
  if (found.condition_number > kReliableCondition)
    report.advice = where_to_measure_next(rows, best.estimate, free, found.condition_number);
  require_identifiable(found, table.source,
                       report.advice.empty() ? "measure at more places, with other turns of the wrist"
                                             : report.advice.front());
  if (!options.offsets_only) judge("full", free, best);

  const std::vector<double> residuals = errors_of(best.estimate, rows);
  constexpr double kNoOutlier = 1e-3;  // [m], what placing a tip by hand may be off
  report.outliers = outlying(residuals, kNoOutlier);
  const double sigma =
      residual_deviation(residuals, 3, linear.columns, options.loss != Loss::kSquare, kNoOutlier);
  for (std::size_t i = 0; i < free.size(); ++i) {
    const bool length = free[i].second == DhhQuantity::kD || free[i].second == DhhQuantity::kA;
    report.parameters.push_back({linear.names[i], best.problem.parameters[0].values[i],
                                 sigma * found.standard_deviations[i], length ? "m" : "rad"});
  }
  report.seconds = watch.seconds();
  return out;
}

}  // namespace palpate
