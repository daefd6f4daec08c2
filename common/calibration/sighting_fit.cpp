#include "common/calibration/sighting_fit.h"

#include <algorithm>
#include <cmath>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {
namespace {

constexpr double kNoOutlier = 1e-4;  // [m], what a tracker's noise may be

ParameterBlock point_block(const std::string& name) {
  return {.values = {0.0, 0.0, 0.0}, .names = {name + ".x", name + ".y", name + ".z"}};
}

/// Minimizes, refuses what is singular, and reports parameters with deviations from the residuals.
/// @param axes that a measurement tells of.
void finish(LeastSquaresProblem& problem, const PointFitOptions& options, const std::string& source,
            const std::string& remedy, std::size_t axes, FitReport& report) {
  const LeastSquaresSummary summary =
      minimize(problem, {.loss = options.loss, .loss_scale = options.loss_scale});
  const Linearization linear = linearize(problem);
  const Identifiability found = analyze(linear);
  require_identifiable(found, source, remedy);
  // Noise alone makes a matrix regular: a fit this weak says nothing either.
  constexpr double kHopeless = 300.0;
  if (found.condition_number > kHopeless)
    throw input_error({.file = source,
                       .place = "",
                       .found = "these measurements hardly tell apart " + described(found.weak.front()) +
                                " (condition number " + short_number(std::round(found.condition_number)) +
                                ")",
                       .expected = "",
                       .remedy = remedy});
  describe(report, found);
  report.iterations += summary.iterations;
  std::vector<double> residuals;
  for (std::size_t i = 0; i + 2 < linear.residuals.size(); i += 3)
    residuals.push_back(glm::length(vector(&linear.residuals[i])));
  const double sigma =
      residual_deviation(residuals, axes, linear.columns, options.loss != Loss::kSquare, kNoOutlier);
  std::size_t column = 0;
  for (const ParameterBlock& block : problem.parameters) {
    for (std::size_t i = 0; i < 3; ++i, ++column) {
      report.parameters.push_back(
          {block.names[i], block.values[i], sigma * found.standard_deviations[column], "m"});
    }
  }
}

void require_rows(std::size_t rows, std::size_t fewest, const std::string& source, const std::string& of,
                  const std::string& remedy) {
  if (rows >= fewest) return;
  throw input_error({.file = source,
                     .place = "",
                     .found = counted(rows, "measurement") + of,
                     .expected = std::to_string(fewest) + " at least",
                     .remedy = remedy});
}

LeastSquaresProblem pivot_problem(const std::vector<PivotMeasurement>& rows) {
  LeastSquaresProblem problem;
  problem.parameters = {point_block("tip"), point_block("pivot")};
  for (const PivotMeasurement& row : rows) {
    problem.residuals.push_back(
        {.parameters = {0, 1}, .dimension = 3, .evaluate = [row](const double* const* x, double* r) {
           write_residuals(r, row.position + row.orientation * vector(x[0]) - vector(x[1]));
         }});
  }
  return problem;
}

/// The part of x - a across the line from a to b.
Vec3 off_line(const Vec3& x, const SightingMeasurement& row) {
  const Vec3 along = glm::normalize(row.far - row.near), from = x - row.near;
  return from - glm::dot(from, along) * along;
}

LeastSquaresProblem eye_problem(const std::vector<SightingMeasurement>& rows, const std::string& name) {
  LeastSquaresProblem problem;
  problem.parameters = {point_block(name)};
  for (const SightingMeasurement& row : rows) {
    problem.residuals.push_back(
        {.parameters = {0}, .dimension = 3, .evaluate = [row](const double* const* x, double* r) {
           write_residuals(r, off_line(row.head.position + row.head.orientation * vector(x[0]), row));
         }});
  }
  return problem;
}

}  // namespace

PivotFit calibrate_pivot(const MeasurementTable<PivotMeasurement>& table, const PointFitOptions& options) {
  const Stopwatch watch;
  const std::string remedy =
      "keep the tip in its place and tilt the stylus by 30 degrees and more to all four sides";
  require_rows(table.rows.size(), 4, table.source, "", remedy);
  PivotFit out;
  LeastSquaresProblem problem = pivot_problem(table.rows);
  finish(problem, options, table.source, remedy, 3, out.report);
  out.tip = vector(problem.parameters[0].values.data());
  out.pivot = vector(problem.parameters[1].values.data());
  FitReport& report = out.report;
  report.kind = "pivot";
  report.source = table.source;
  report.measurements = table.rows.size();
  report.seconds = watch.seconds();

  struct Points {
    Vec3 tip{0.0}, pivot{0.0};
  };
  const auto error = [](const Points& p, const PivotMeasurement& row) {
    return glm::distance(row.position + row.orientation * p.tip, p.pivot);
  };
  std::vector<double> residuals;
  for (const PivotMeasurement& row : table.rows) residuals.push_back(error({out.tip, out.pivot}, row));
  report.errors.push_back(distance_row("fitted", false, residuals));
  report.outliers = outlying(residuals, kNoOutlier);
  if (table.rows.size() >= 2 * options.folds) {
    report.errors.push_back(
        distance_row("fitted", true,
                     left_out_errors(
                         table.rows, options.folds,
                         [&](const std::vector<PivotMeasurement>& kept) {
                           LeastSquaresProblem part = pivot_problem(kept);
                           minimize(part, {.loss = options.loss, .loss_scale = options.loss_scale});
                           return Points{vector(part.parameters[0].values.data()),
                                         vector(part.parameters[1].values.data())};
                         },
                         error)));
  }
  return out;
}

EyeFit calibrate_eyes(const MeasurementTable<SightingMeasurement>& table, const PointFitOptions& options) {
  const Stopwatch watch;
  const std::string remedy =
      "sight along lines that differ by 30 degrees and more as seen from the head: turn the head, not "
      "only the eyes";
  EyeFit out;
  FitReport& report = out.report;
  report.kind = "eyes";
  report.source = table.source;
  report.measurements = table.rows.size();
  require_rows(table.rows.size(), 1, table.source, "", remedy);
  std::vector<double> residuals, left_out;
  const auto error = [](const Vec3& eye, const SightingMeasurement& row) {
    return glm::length(off_line(row.head.position + row.head.orientation * eye, row));
  };
  double worst = 0.0;
  for (const bool right : {false, true}) {
    std::vector<SightingMeasurement> rows;
    std::vector<std::size_t> numbers;  // of the table, from 1
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      if (table.rows[i].right != right) continue;
      rows.push_back(table.rows[i]);
      numbers.push_back(i + 1);
    }
    if (rows.empty()) continue;
    const std::string name = right ? "right" : "left";
    require_rows(rows.size(), 3, table.source, " of the " + name + " eye", remedy);
    LeastSquaresProblem problem = eye_problem(rows, name);
    // A sighting fixes two of three directions.
    finish(problem, options, table.source, remedy, 2, report);
    worst = std::max(worst, report.condition_number);
    const Vec3 eye = vector(problem.parameters[0].values.data());
    (right ? out.right : out.left) = eye;
    std::vector<double> left;
    for (const SightingMeasurement& row : rows) left.push_back(error(eye, row));
    for (const std::size_t row : outlying(left, kNoOutlier)) report.outliers.push_back(numbers[row - 1]);
    residuals.insert(residuals.end(), left.begin(), left.end());
    if (rows.size() < 2 * options.folds) continue;
    const std::vector<double> part = left_out_errors(
        rows, options.folds,
        [&](const std::vector<SightingMeasurement>& kept) {
          LeastSquaresProblem less = eye_problem(kept, name);
          minimize(less, {.loss = options.loss, .loss_scale = options.loss_scale});
          return vector(less.parameters[0].values.data());
        },
        error);
    left_out.insert(left_out.end(), part.begin(), part.end());
  }
  report.condition_number = worst;
  std::ranges::sort(report.outliers);
  report.seconds = watch.seconds();
  report.errors.push_back(distance_row("fitted", false, residuals));
  if (!left_out.empty()) report.errors.push_back(distance_row("fitted", true, left_out));
  if (out.left && out.right) {
    out.separation = glm::distance(*out.left, *out.right);
    // Adults' eyes stand 51 to 77 mm apart (Dodgson 2004, 5th to 95th percentile widened).
    constexpr double kNarrow = 0.045, kWide = 0.080;
    if (*out.separation < kNarrow || *out.separation > kWide)
      report.advice.push_back("the eyes came out " + short_number(std::round(1e4 * *out.separation) / 10.0) +
                              " mm apart, which no adult's are: check which eye each row is of");
  }
  return out;
}

}  // namespace palpate
