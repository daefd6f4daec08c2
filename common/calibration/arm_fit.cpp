#include "common/calibration/arm_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Dense>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/calibration/fit_report.h"
#include "common/calibration/registration.h"
#include "common/math/counter_random.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

double& at(DhhChain& chain, const DhhPlace& place) {
  return chain.rows[as_size(place.first)].values[as_size(place.second)];
}

DhhChain with_numbers(DhhChain chain, const std::vector<DhhPlace>& free, const double* numbers) {
  for (std::size_t i = 0; i < free.size(); ++i) at(chain, free[i]) = numbers[i];
  return chain;
}

Rigid motion(const double* position, const double* rotation) {
  return {glm::normalize(Quat{rotation[0], rotation[1], rotation[2], rotation[3]}),
          {position[0], position[1], position[2]}};
}

std::size_t grid_count(const std::vector<ArmMeasurement>& rows) {
  int most = 0;
  for (const ArmMeasurement& row : rows) most = std::max(most, row.grid);
  return as_size(most) + 1;
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
  return glm::distance(e.grids[as_size(row.grid)] * row.point, e.chain.forward(row.readings).translation);
}

std::vector<double> errors_of(const ArmEstimate& e, const std::vector<ArmMeasurement>& rows) {
  std::vector<double> out;
  for (const ArmMeasurement& row : rows) out.push_back(error_of(e, row));
  return out;
}

constexpr double kPlacingByHand =
    2e-4;  // [m] no hand puts a tip more exactly, however well a few measurements agree
constexpr double kUnknownNoise = 5e-3;  // [m] as much was fitted as was measured

/// How far from a flat plate the nominal arm puts the points of the first grid, in half of all cases [m].
double nominal_error(const std::vector<ArmMeasurement>& rows, const DhhChain& chain, double turn,
                     double length) {
  std::vector<double> errors;
  for (ArmMeasurement row : rows) {
    if (row.grid != 0) continue;
    for (double& reading : row.readings) reading *= turn;
    errors.push_back(glm::distance(length * row.point, chain.forward(row.readings).translation));
  }
  if (errors.empty()) return NAN;
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return *middle;
}

/// Refuses a table that fits the nominal arm well once it is read in other units. A nominal arm is off by some
/// centimetres; errors beyond that are none of its offsets.
void refuse_slips(const std::vector<ArmMeasurement>& rows, const DhhChain& nominal,
                  const std::string& source) {
  constexpr double kNominal = 0.2, kBetter = 0.4, kTwoTurns = 12.6;  // [m], 1, [rad]
  const double before = nominal_error(rows, nominal, 1.0, 1.0);
  const bool turned = std::any_of(rows.begin(), rows.end(), [](const ArmMeasurement& row) {
    return std::any_of(row.readings.begin(), row.readings.end(),
                       [](double reading) { return std::abs(reading) > kTwoTurns; });
  });
  if (!(before > kNominal) && !turned) return;
  struct Slip {
    const char* what;
    double turn, length;
  };
  constexpr std::array kSlips{
      Slip{"the readings look like degrees", kDegree, 1.0},
      Slip{"the points look like millimetres", 1.0, 1e-3},
      Slip{"the points look like centimetres", 1.0, 1e-2},
      Slip{"the readings look like degrees and the points like millimetres", kDegree, 1e-3}};
  const Slip* best = nullptr;
  double least = kBetter * before;
  for (const Slip& slip : kSlips) {
    const double then = nominal_error(rows, nominal, slip.turn, slip.length);
    if (!(then < least)) continue;
    least = then;
    best = &slip;
  }
  if (best == nullptr) return;
  throw input_error({.file = source,
                     .place = "",
                     .found = std::string(best->what) + ": so read, the nominal arm is " +
                              short_number(std::round(1e3 * least)) + " mm off in half of the cases, not " +
                              short_number(std::round(1e3 * before)),
                     .expected = "metres and radians",
                     .remedy = "write them so"});
}

/// Refuses a fit that betters nothing.
void require_betterment(const FitReport& report, const std::string& method) {
  constexpr double kNoise = 2.0, kLess = 0.95;  // [mm] below it there is nothing to better
  const ErrorRow* const before = report.find("nominal", "distance", false);
  const ErrorRow* const after = report.find(method, "distance", true);
  if (before == nullptr || after == nullptr || before->errors.mean <= kNoise) return;
  if (after->errors.mean < kLess * before->errors.mean) return;
  throw work_error(
      report.source + ": the fit leaves " + short_number(std::round(10.0 * after->errors.mean) / 10.0) +
      " mm of " + short_number(std::round(10.0 * before->errors.mean) / 10.0) +
      " mm on points that it has not seen: check which readings belong to which point, and --nominal");
}

/// Gross errors are to be looked at before anything else is measured.
std::string gross_remedy(const FitReport& report, const std::string& otherwise) {
  if (report.outliers.empty()) return otherwise;
  constexpr std::size_t kNamed = 6;
  std::string rows;
  for (std::size_t i = 0; i < std::min(kNamed, report.outliers.size()); ++i)
    rows += (i == 0 ? "" : ", ") + std::to_string(report.outliers[i]);
  return "look at measurements " + rows + (report.outliers.size() > kNamed ? ", …" : "") +
         ", which fit badly, or take a robust loss; " + otherwise;
}

void require_certainty(const std::vector<double>& predicted, const Identifiability& found,
                       const std::string& source, const std::string& remedy) {
  const double worst = *std::max_element(predicted.begin(), predicted.end());
  if (worst <= kMostPredicted) return;
  throw input_error({.file = source,
                     .place = "",
                     .found = "from these measurements the tip is uncertain by up to " +
                              short_number(std::round(1e3 * worst)) +
                              " mm in the workspace (condition number " +
                              short_number(std::round(found.condition_number)) + ")",
                     .expected = short_number(1e3 * kMostPredicted) + " mm at most",
                     .remedy = remedy});
}

}  // namespace

std::vector<DhhPlace> full_parameters(const DhhChain& chain) {
  std::vector<DhhPlace> out;
  for (std::size_t row = 0; row < chain.rows.size(); ++row) {
    for (int q = 0; q < kDhhQuantities; ++q) {
      if (chain.rows[row].free[as_size(q)])
        out.emplace_back(static_cast<int>(row), static_cast<DhhQuantity>(q));
    }
  }
  return out;
}

std::vector<DhhPlace> offset_parameters(const DhhChain& chain) {
  std::vector<DhhPlace> out;
  for (const DhhPlace& place : full_parameters(chain)) {
    const bool joint = chain.rows[as_size(place.first)].joint >= 0;
    if (joint && place.second == DhhQuantity::kGamma) out.push_back(place);
  }
  return out;
}

LeastSquaresProblem arm_problem(const std::vector<ArmMeasurement>& rows, const DhhChain& chain,
                                const std::vector<Rigid>& grids, const std::vector<DhhPlace>& free) {
  LeastSquaresProblem problem;
  ParameterBlock numbers;
  DhhChain start = chain;
  for (const DhhPlace& place : free) {
    numbers.values.push_back(at(start, place));
    numbers.names.push_back(dhh_name(place.first, place.second));
  }
  if (free.empty()) {  // only the grids are asked for
    numbers.values = {0.0};
    numbers.names = {"none"};
    numbers.fixed = true;
  }
  problem.parameters.push_back(std::move(numbers));
  for (std::size_t g = 1; g < grids.size(); ++g) {
    const std::string name = "grid" + std::to_string(g);
    const Vec3& t = grids[g].translation;
    const Quat& q = grids[g].rotation;
    problem.parameters.push_back(
        {.values = {t.x, t.y, t.z}, .names = {name + ".x", name + ".y", name + ".z"}});
    problem.parameters.push_back({.values = {q.w, q.x, q.y, q.z},
                                  .names = {name + ".1", name + ".2", name + ".3"},
                                  .quaternion = true});
  }
  for (const ArmMeasurement& row : rows) {
    ResidualBlock block;
    block.dimension = 3;
    block.parameters = {0};
    const auto grid = as_size(row.grid);
    if (grid > 0) block.parameters.insert(block.parameters.end(), {2 * grid - 1, 2 * grid});
    block.evaluate = [row, chain, free](const double* const* x, double* r) {
      const Vec3 tip = with_numbers(chain, free, x[0]).forward(row.readings).translation;
      const Vec3 put = row.grid > 0 ? motion(x[1], x[2]) * row.point : row.point;
      for (int axis = 0; axis < 3; ++axis) r[axis] = put[axis] - tip[axis];
    };
    problem.residuals.push_back(std::move(block));
  }
  return problem;
}

ArmEstimate arm_estimate(const LeastSquaresProblem& problem, const DhhChain& chain, std::size_t grid_count,
                         const std::vector<DhhPlace>& free) {
  ArmEstimate out{with_numbers(chain, free, problem.parameters[0].values.data()), {Rigid{}}};
  for (std::size_t g = 1; g < grid_count; ++g) {
    out.grids.push_back(
        motion(problem.parameters[2 * g - 1].values.data(), problem.parameters[2 * g].values.data()));
  }
  return out;
}

ArmFit calibrate_arm(const MeasurementTable<ArmMeasurement>& table, const DhhChain& nominal,
                     const ArmFitOptions& options) {
  const Stopwatch watch;
  const std::vector<ArmMeasurement>& rows = table.rows;
  refuse_slips(rows, nominal, table.source);
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
  const std::string remedy =
      report.advice.empty() ? "measure at more places, with other turns of the wrist" : report.advice.front();
  require_identifiable(found, table.source, remedy);
  if (!options.offsets_only) judge("full", free, best);
  require_betterment(report, options.offsets_only ? "offsets" : "full");

  const std::vector<double> residuals = errors_of(best.estimate, rows);
  constexpr double kNoOutlier = 1e-3;  // [m], what placing a tip by hand may be off
  report.outliers = outlying(residuals, kNoOutlier);
  const double sigma =
      residual_deviation(residuals, 3, linear.columns, options.loss != Loss::kSquare, kNoOutlier);
  const std::vector<double> predicted =
      predicted_errors(rows, best.estimate, free, linear,
                       std::isfinite(sigma) ? std::max(sigma, kPlacingByHand) : kUnknownNoise);
  report.errors.push_back(distance_row("predicted", true, predicted));
  require_certainty(predicted, found, table.source, gross_remedy(report, remedy));
  for (std::size_t i = 0; i < free.size(); ++i) {
    const bool length = free[i].second == DhhQuantity::kD || free[i].second == DhhQuantity::kA;
    report.parameters.push_back({linear.names[i], best.problem.parameters[0].values[i],
                                 sigma * found.standard_deviations[i], length ? "m" : "rad"});
  }
  report.seconds = watch.seconds();
  return out;
}

namespace {

constexpr std::size_t kPoses = 20;     // of a further grid, as in the reference
constexpr std::size_t kTries = 40000;  // random poses that are looked through for them
constexpr double kSlab = 0.01;         // [m]: this near to a plane counts as on it
constexpr double kReach = 0.5;         // [m] from the middle of what was measured
constexpr double kBeside = 0.25;       // [m] to a parallel grid

struct Plane {
  Vec3 origin{0.0}, normal{0.0};
  std::string words;
};

std::string place_text(const Vec3& x) {
  const auto two = [](double v) {
    return short_number(std::round(100.0 * v) / 100.0 + 0.0);
  };  // + 0: no "-0"
  return "(" + two(x.x) + ", " + two(x.y) + ", " + two(x.z) + ")";
}

Rigid frame_of(const Plane& plane) {
  // The turn that takes z to the normal; any one serves, as the frame is unknown in the fit.
  const Vec3 z{0.0, 0.0, 1.0};
  const double along = glm::dot(z, plane.normal);
  constexpr double kOpposite = -1.0 + 1e-9;
  if (along < kOpposite) return {Quat{0.0, 1.0, 0.0, 0.0}, plane.origin};
  const Vec3 axis = glm::cross(z, plane.normal);
  return {glm::normalize(Quat{1.0 + along, axis.x, axis.y, axis.z}), plane.origin};
}

/// Readings drawn from the ranges that were seen, somewhat widened, and to `least` [rad] each.
std::vector<std::vector<double>> reachable(const std::vector<ArmMeasurement>& rows, std::size_t count,
                                           double least) {
  constexpr double kWider = 1.4;
  const std::size_t joints = rows[0].readings.size();
  std::vector<double> lower(joints, HUGE_VAL), upper(joints, -HUGE_VAL);
  for (const ArmMeasurement& row : rows) {
    for (std::size_t j = 0; j < joints; ++j) {
      lower[j] = std::min(lower[j], row.readings[j]);
      upper[j] = std::max(upper[j], row.readings[j]);
    }
  }
  std::vector<std::vector<double>> out(count, std::vector<double>(joints));
  std::uint64_t counter = 0;
  for (auto& readings : out) {
    for (std::size_t j = 0; j < joints; ++j) {
      const double range = std::max(kWider * (upper[j] - lower[j]), least);
      readings[j] = 0.5 * (lower[j] + upper[j]) + (uniform_at(counter++) - 0.5) * range;
    }
  }
  return out;
}

}  // namespace

std::vector<double> predicted_errors(const std::vector<ArmMeasurement>& rows, const ArmEstimate& estimate,
                                     const std::vector<DhhPlace>& free, const Linearization& linear,
                                     double sigma) {
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto columns = static_cast<Eigen::Index>(linear.columns),
             numbers = static_cast<Eigen::Index>(free.size());
  Matrix a =
      Eigen::Map<const Matrix>(linear.jacobian.data(), static_cast<Eigen::Index>(linear.rows), columns);
  // Columns of unit length: metres and radians beside each other.
  const Eigen::VectorXd lengths = a.colwise().norm().cwiseMax(1e-300);
  for (Eigen::Index c = 0; c < columns; ++c) a.col(c) /= lengths(c);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(a, Eigen::ComputeThinV);
  // Rows of V / s are the unknowns' deviations along each singular direction.
  const Eigen::MatrixXd along = lengths.cwiseInverse().asDiagonal() * svd.matrixV() *
                                svd.singularValues().cwiseMax(1e-300).cwiseInverse().asDiagonal();
  constexpr std::size_t kPlaces = 400;
  constexpr double kWorkspace =
      1.0;  // [rad] a joint that hardly turned while it was measured turns as far in use
  constexpr double kStep = 1e-6;
  std::vector<double> out;
  for (const std::vector<double>& readings : reachable(rows, kPlaces, kWorkspace)) {
    Eigen::MatrixXd tip(3, numbers);
    for (Eigen::Index i = 0; i < numbers; ++i) {
      DhhChain more = estimate.chain, less = estimate.chain;
      at(more, free[as_size(i)]) += kStep;
      at(less, free[as_size(i)]) -= kStep;
      const Vec3 d =
          (more.forward(readings).translation - less.forward(readings).translation) / (2.0 * kStep);
      tip.col(i) << d.x, d.y, d.z;
    }
    out.push_back(sigma * (tip * along.topRows(numbers)).norm());
  }
  return out;
}

std::vector<std::string> where_to_measure_next(const std::vector<ArmMeasurement>& rows,
                                               const ArmEstimate& estimate, const std::vector<DhhPlace>& free,
                                               double now) {
  Vec3 middle{0.0};
  std::vector<Vec3> tips;
  for (const ArmMeasurement& row : rows) {
    tips.push_back(estimate.chain.forward(row.readings).translation);
    middle += tips.back() / static_cast<double>(rows.size());
  }
  Mat3 spread{0.0};
  for (const Vec3& tip : tips) spread += glm::outerProduct(tip - middle, tip - middle);
  const SymmetricEigen axes = symmetric_eigen(spread);
  const Vec3 normal = axes.vectors[2];
  std::vector<Plane> planes{{middle + kBeside * normal, normal, "parallel to the first one"},
                            {middle - kBeside * normal, normal, "parallel to the first one"}};
  for (const int across : {0, 1})
    planes.push_back({middle, axes.vectors[across], "nearly perpendicular to the first one"});

  const auto candidates = reachable(rows, kTries, 0.0);
  std::vector<Vec3> candidate_tips;
  candidate_tips.reserve(candidates.size());
  for (const auto& readings : candidates)
    candidate_tips.push_back(estimate.chain.forward(readings).translation);
  std::vector<std::pair<double, std::string>> ranked;
  for (const Plane& plane : planes) {
    const Rigid frame = frame_of(plane);
    const int grid = static_cast<int>(estimate.grids.size());
    std::vector<ArmMeasurement> all = rows;
    for (std::size_t c = 0; c < candidates.size() && all.size() < rows.size() + kPoses; ++c) {
      const Vec3 from = candidate_tips[c] - plane.origin;
      if (std::abs(glm::dot(from, plane.normal)) > kSlab || glm::length(from) > kReach) continue;
      all.push_back({frame.inverse() * candidate_tips[c], candidates[c], grid});
    }
    if (all.size() < rows.size() + kPoses) continue;  // the arm hardly gets there
    std::vector<Rigid> grids = estimate.grids;
    grids.push_back(frame);
    const double then = analyze(linearize(arm_problem(all, estimate.chain, grids, free))).condition_number;
    if (!(then < now)) continue;
    ranked.emplace_back(
        then, "measure " + std::to_string(kPoses) + " points of a further grid " + plane.words +
                  ", through " + place_text(plane.origin) + " m across " + place_text(plane.normal) +
                  ", the wrist turned at random: the condition number would fall from " +
                  short_number(std::round(now)) + " to about " + short_number(std::round(then)));
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<std::string> out;
  out.reserve(ranked.size());
  for (auto& [then, words] : ranked) out.push_back(std::move(words));
  return out;
}

}  // namespace palpate
