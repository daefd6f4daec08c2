#include "common/calibration/tracker_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Dense>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/calibration/error_spline_fit.h"
#include "common/calibration/metal_fit.h"
#include "common/calibration/tracker_checks.h"

namespace palpate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Errors at reported places: what all methods fit.
struct Samples {
  std::vector<Vec3> places;
  MatrixXd errors;  ///< N x 6: position, orientation
};

Eigen::RowVectorXd six_of(const PoseError& e) {
  Eigen::RowVectorXd six(6);
  six << e.position.x, e.position.y, e.position.z, e.orientation.x, e.orientation.y, e.orientation.z;
  return six;
}

Samples samples_of(const std::vector<TrackerMeasurement>& rows) {
  Samples out{{}, MatrixXd(static_cast<Index>(rows.size()), 6)};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    out.places.push_back(rows[i].reported.position);
    out.errors.row(static_cast<Index>(i)) = six_of(pose_error(rows[i].actual, rows[i].reported));
  }
  return out;
}

/// Refuses places that all lie near a plane, a line or a point.
void require_volume(const std::vector<Vec3>& places, const std::string& source) {
  Vec3 mean{0.0};
  for (const Vec3& p : places) mean += p / static_cast<double>(places.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vec3& p : places) {
    const Eigen::Vector3d d(p.x - mean.x, p.y - mean.y, p.z - mean.z);
    spread += d * d.transpose() / static_cast<double>(places.size());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  const double thin = std::sqrt(std::max(axes.eigenvalues()(0), 0.0));
  const double wide = std::sqrt(axes.eigenvalues()(2));
  constexpr double kFlat = 0.02;  // thinner than that of the width, powers across are only noise
  if (wide > 0.0 && thin >= kFlat * wide) return;
  const Eigen::Vector3d n = axes.eigenvectors().col(0);
  throw input_error({.file = source,
                     .place = "",
                     .found = "all measurements lie near a plane, within " + short_number(1e3 * thin) + " mm",
                     .expected = "places that fill the volume",
                     .remedy = "measure more along (" + short_number(n.x()) + ", " + short_number(n.y()) +
                               ", " + short_number(n.z()) + ") as well"});
}

MatrixXd design(const std::vector<Vec3>& places, const VectorPolynomial& frame) {
  const Index terms = term_count(frame.degree);
  MatrixXd a(static_cast<Index>(places.size()), terms);
  std::vector<double> row(as_size(terms));
  for (std::size_t i = 0; i < places.size(); ++i) {
    monomials((places[i] - frame.center) / frame.scale, frame.degree, row);
    a.row(static_cast<Index>(i)) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), terms);
  }
  return a;
}

/// How much a row counts by the length r of its residual: the square root of the weight of a robust loss with
/// the deviation `sigma` of an axis. Huber's falls as 1 / r, Cauchy's as 1 / r^2: it forgets what is far off.
double robust_weight(Loss loss, double r, double sigma) {
  // 95 % of the efficiency of plain squares on normal errors.
  constexpr double kHuber = 1.345, kCauchy = 2.385;
  const double bound = std::sqrt(3.0) * sigma * (loss == Loss::kCauchy ? kCauchy : kHuber);
  if (loss == Loss::kCauchy) return 1.0 / std::sqrt(1.0 + (r / bound) * (r / bound));
  return r > bound ? std::sqrt(bound / r) : 1.0;
}

/// Least squares for three right-hand sides, with a robust loss's weights by the length of a row's residual if
/// asked.
MatrixXd solved(const MatrixXd& a, const MatrixXd& b, Loss loss) {
  MatrixXd c = a.householderQr().solve(b);
  constexpr int kRounds = 20;  // of reweighting; Huber's weights settle in a few
  for (int round = 0; loss != Loss::kSquare && round < kRounds; ++round) {
    const VectorXd lengths = (b - a * c).rowwise().norm();
    std::vector<double> sorted(lengths.data(), lengths.data() + lengths.size());
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                     sorted.end());
    constexpr double kMedianNorm = 1.54;
    const double sigma = sorted[sorted.size() / 2] / kMedianNorm;
    if (!(sigma > 0.0)) break;
    // Cauchy's loss has many minima: Huber's single one is where it starts from.
    const Loss now = loss == Loss::kCauchy && round < kRounds / 2 ? Loss::kHuber : loss;
    const VectorXd weights = lengths.unaryExpr([&](double r) { return robust_weight(now, r, sigma); });
    c = (weights.asDiagonal() * a).householderQr().solve(weights.asDiagonal() * b);
  }
  return c;
}

struct PolynomialFit {
  VectorPolynomial position, orientation;
  Linearization linearization;  ///< of one component: the same for all six
};

PolynomialFit fit_polynomials(const Samples& samples, int degree, Loss loss, const std::string& source) {
  const auto terms = as_size(term_count(degree));
  if (samples.places.size() <= terms) {
    int bearable = -1;
    while (as_size(term_count(bearable + 1)) < samples.places.size()) ++bearable;
    throw input_error({.file = source,
                       .place = "",
                       .found = counted(samples.places.size(), "measurement") +
                                " for the fit of a polynomial of degree " + std::to_string(degree),
                       .expected = "more than " + std::to_string(terms),
                       .remedy = bearable >= 0 ? "measure more places, or ask for degree " +
                                                     std::to_string(bearable) + " at most"
                                               : "measure more places"});
  }
  const Box box = box_of(samples.places);
  PolynomialFit out;
  out.position.degree = out.orientation.degree = degree;
  out.position.center = out.orientation.center = box.center();
  out.position.scale = out.orientation.scale = std::max(0.5 * box.diagonal() / std::sqrt(3.0), 1e-9);
  const MatrixXd a = design(samples.places, out.position);
  const MatrixXd cp = solved(a, samples.errors.leftCols(3), loss);
  const MatrixXd cq = solved(a, samples.errors.rightCols(3), loss);
  for (Index j = 0; j < cp.rows(); ++j) {
    out.position.coefficients.emplace_back(cp(j, 0), cp(j, 1), cp(j, 2));
    out.orientation.coefficients.emplace_back(cq(j, 0), cq(j, 1), cq(j, 2));
  }
  Linearization& lin = out.linearization;
  lin.rows = as_size(a.rows());
  lin.columns = terms;
  for (Index i = 0; i < a.rows(); ++i)
    lin.jacobian.insert(lin.jacobian.end(), a.row(i).begin(), a.row(i).end());
  for (int s = 0; s <= degree; ++s) {
    for (int t = 0; t <= degree - s; ++t) {
      for (int u = 0; u <= degree - s - t; ++u)
        lin.names.push_back("x^" + std::to_string(s) + " y^" + std::to_string(t) + " z^" + std::to_string(u));
    }
  }
  return out;
}

/// What `error_at(place)` says at the nodes of a lattice over `places`.
template <class ErrorAt>
ErrorTable sampled(const ErrorAt& error_at, const std::vector<Vec3>& places, int nodes) {
  const Box box = box_of(places);
  const Vec3 size = box.size();
  const double longest = std::max({size.x, size.y, size.z});
  // Half the distance at which measurements stand apart keeps the trilinear error below the spline's own.
  const double apart = std::cbrt(size.x * size.y * size.z / static_cast<double>(places.size()));
  const double step = nodes > 1 ? longest / (nodes - 1) : std::max(0.5 * apart, longest / 40.0);
  ErrorTable out;
  out.lower = box.lower;
  for (int axis = 0; axis < 3; ++axis) {
    out.count[axis] = std::max(2, static_cast<int>(std::ceil(size[axis] / step)) + 1);
    out.spacing[axis] = std::max(size[axis], 1e-9) / (out.count[axis] - 1);
  }
  for (int z = 0; z < out.count.z; ++z) {
    for (int y = 0; y < out.count.y; ++y) {
      for (int x = 0; x < out.count.x; ++x)
        out.values.push_back(error_at(out.lower + Vec3(x, y, z) * out.spacing));
    }
  }
  return out;
}

/// The samples with `kept`, errors from `errors`.
std::pair<std::vector<Vec3>, MatrixXd> part_of(const std::vector<Vec3>& places, const MatrixXd& errors,
                                               const std::vector<bool>& kept) {
  std::pair<std::vector<Vec3>, MatrixXd> out{{}, MatrixXd(std::count(kept.begin(), kept.end(), true), 6)};
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!kept[i]) continue;
    out.second.row(static_cast<Index>(out.first.size())) = errors.row(static_cast<Index>(i));
    out.first.push_back(places[i]);
  }
  return out;
}

/// Those that are no gross errors, by what `predicted` says of each place: five robust deviations.
template <class Predicted>
std::vector<bool> plausible(const Samples& samples, const Predicted& predicted) {
  constexpr double kFloor = 1e-3, kTurnFloor = 2e-3;  // [m], [rad] what a tracker's noise may be
  std::vector<double> position, orientation;
  for (std::size_t i = 0; i < samples.places.size(); ++i) {
    const PoseError measured = pose_error_of(samples.errors.row(static_cast<Index>(i)).transpose());
    const PoseError e = predicted(samples.places[i]);
    position.push_back(glm::distance(measured.position, e.position));
    orientation.push_back(glm::distance(measured.orientation, e.orientation));
  }
  std::vector<bool> out(samples.places.size(), true);
  for (const std::size_t row : outlying(position, kFloor)) out[row - 1] = false;
  for (const std::size_t row : outlying(orientation, kTurnFloor)) out[row - 1] = false;
  return out;
}

/// A spline through gross errors follows them: what a robust polynomial does not explain is left out, and comes
/// back where the spline of the others does, which is where the field itself is steep.
std::vector<bool> without_gross_errors(const Samples& samples, const TrackerFitOptions& options,
                                       const std::string& source) {
  int degree = options.degree;
  while (degree > 1 && as_size(term_count(degree)) * 2 > samples.places.size()) --degree;
  TrackerCorrection polynomial;
  PolynomialFit fit = fit_polynomials(samples, degree, options.loss, source);
  polynomial.position = std::move(fit.position);
  polynomial.orientation = std::move(fit.orientation);
  std::vector<bool> kept = plausible(samples, [&](const Vec3& p) { return polynomial.error_at(p); });
  constexpr int kRounds = 2;
  for (int round = 0; round < kRounds; ++round) {
    const auto [places, errors] = part_of(samples.places, samples.errors, kept);
    const ErrorSpline spline = fit_spline(places, errors);
    if (spline.centers.empty()) break;
    const std::vector<bool> explained = plausible(samples, [&](const Vec3& p) { return spline.at(p); });
    for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = kept[i] || explained[i];
  }
  return kept;
}

/// Those measurements that a spline may follow.
std::vector<bool> trusted(const Samples& samples, const TrackerFitOptions& options,
                          const std::string& source) {
  return options.loss == Loss::kSquare ? std::vector<bool>(samples.places.size(), true)
                                       : without_gross_errors(samples, options, source);
}

bool has_metal(TrackerMethod method) {
  return method == TrackerMethod::kDipoles || method == TrackerMethod::kCombinedDipoles;
}

/// A correction, and the metal that it was made from, where it was.
struct Fitted {
  TrackerCorrection correction;
  MetalModel metal;
  std::size_t unread = 0;  ///< nodes of the table where the metal lets nothing be read
};

/// As a table of what a model of the metal says of each place, with what it leaves of the measurements if asked.
Fitted fitted_by_metal(const std::vector<TrackerMeasurement>& rows, const Samples& samples,
                       const TrackerFitOptions& options, const std::string& source) {
  Fitted out{.correction = {}, .metal = fit_metal(rows, options.loss, source)};
  ErrorSpline rest;
  if (options.method == TrackerMethod::kCombinedDipoles) {
    MatrixXd left = samples.errors;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const PoseError e = out.metal.error_of(rows[i].actual.position);
      left.row(static_cast<Index>(i)) -= six_of(e);
    }
    const auto [places, errors] = part_of(samples.places, left, trusted(samples, options, source));
    rest = fit_spline(places, errors);
  }
  out.correction.table = sampled(
      [&](const Vec3& p) {
        PoseError e = out.metal.error_at(p);
        if (!is_finite(e.position) || !is_finite(e.orientation)) {
          // Nothing is read there, in a corner of the box about what is.
          ++out.unread;
          const auto nearest = std::min_element(rows.begin(), rows.end(), [&p](const auto& a, const auto& b) {
            return glm::distance(a.reported.position, p) < glm::distance(b.reported.position, p);
          });
          e = out.metal.error_of(nearest->actual.position);
        }
        return rest.centers.empty() ? e : e + rest.at(p);
      },
      samples.places, options.table_nodes);
  return out;
}

TrackerCorrection fitted(const Samples& samples, const TrackerFitOptions& options,
                         const std::string& source) {
  TrackerCorrection out;
  MatrixXd left = samples.errors;
  if (options.method != TrackerMethod::kTable && options.method != TrackerMethod::kSpline) {
    PolynomialFit polynomial = fit_polynomials(samples, options.degree, options.loss, source);
    out.position = std::move(polynomial.position);
    out.orientation = std::move(polynomial.orientation);
    if (options.method == TrackerMethod::kPolynomial) return out;
    for (std::size_t i = 0; i < samples.places.size(); ++i) {
      left.row(static_cast<Index>(i)) -= six_of(out.error_at(samples.places[i]));
    }
  }
  const auto [places, errors] = part_of(samples.places, left, trusted(samples, options, source));
  out.spline = fit_spline(places, errors);
  if (options.method == TrackerMethod::kTable || options.method == TrackerMethod::kCombined) {
    out.table = sampled([&out](const Vec3& p) { return out.spline.at(p); }, places, options.table_nodes);
    out.spline = {};
  }
  return out;
}

void add_rows(FitReport& report, const std::string& method, bool left_out, const std::vector<Left>& errors) {
  std::vector<double> position, orientation;
  for (const Left& e : errors) {
    position.push_back(1e3 * e.position);
    orientation.push_back(e.orientation / kDegree);
  }
  report.errors.push_back({method, "position", "mm", left_out, statistics_of(position)});
  report.errors.push_back({method, "orientation", "deg", left_out, statistics_of(orientation)});
}

/// Seconds of one evaluation.
double evaluation_seconds(const TrackerCorrection& correction, const std::vector<TrackerMeasurement>& rows) {
  constexpr std::size_t kTimes = 2000;
  double sum = 0.0;
  const Stopwatch watch;
  for (std::size_t i = 0; i < kTimes; ++i)
    sum += correction.corrected(rows[i % rows.size()].reported).position.x;
  return std::isfinite(sum) ? watch.seconds() / kTimes : 0.0;
}

}  // namespace

std::string name_of(TrackerMethod method) {
  switch (method) {
    case TrackerMethod::kPolynomial:
      return "polynomial";
    case TrackerMethod::kTable:
      return "table";
    case TrackerMethod::kSpline:
      return "spline";
    case TrackerMethod::kCombined:
      return "combined";
    case TrackerMethod::kCombinedSpline:
      return "combined-spline";
    case TrackerMethod::kDipoles:
      return "dipoles";
    case TrackerMethod::kCombinedDipoles:
      return "combined-dipoles";
  }
  return {};
}

namespace {

Fitted fit_with_metal(const std::vector<TrackerMeasurement>& rows, const TrackerFitOptions& options,
                      const std::string& source) {
  const Samples samples = samples_of(rows);
  // Ten measurements are the least from which a table says more than their mean.
  constexpr std::size_t kFewest = 10;
  if (rows.size() < kFewest)
    throw input_error({.file = source,
                       .place = "",
                       .found = counted(rows.size(), "measurement") + " for the fit",
                       .expected = std::to_string(kFewest) + " at least",
                       .remedy = "measure on a grid through the tracked volume"});
  require_volume(samples.places, source);
  if (has_metal(options.method)) return fitted_by_metal(rows, samples, options, source);
  return {.correction = fitted(samples, options, source), .metal = {}};
}

/// What a report says of the metal.
void describe_metal(FitReport& report, const MetalModel& metal) {
  int number = 0;
  for (const MetalSource& each : metal.sources) {
    const bool piece = each.kind == MetalSource::Kind::kPiece;
    const std::string name = (piece ? "piece " : "sheet ") + std::to_string(++number);
    for (int axis = 0; axis < 3; ++axis)
      report.parameters.push_back({name + " " + "xyz"[axis], each.place[axis], NAN, "m"});
    report.parameters.push_back({name + " strength", each.strength, NAN, piece ? "m^3" : "1"});
  }
  report.parameters.push_back({"turn factor", metal.turn_factor, NAN, "1"});
}

}  // namespace

TrackerCorrection fit_tracker(const std::vector<TrackerMeasurement>& rows, const TrackerFitOptions& options,
                              const std::string& source) {
  return fit_with_metal(rows, options, source).correction;
}

TrackerFit calibrate_tracker(const MeasurementTable<TrackerMeasurement>& table,
                             const TrackerFitOptions& options) {
  const Stopwatch watch;
  std::vector<TrackerMeasurement> fit, validation;
  std::vector<std::size_t> fit_rows;  // in the table, from 1
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    (table.rows[i].validation ? validation : fit).push_back(table.rows[i]);
    if (!table.rows[i].validation) fit_rows.push_back(i + 1);
  }
  refuse_slips(table.rows, table.source);
  TrackerFit out;
  Fitted made = fit_with_metal(fit, options, table.source);
  out.correction = std::move(made.correction);
  FitReport& report = out.report;
  report.kind = "tracker";
  report.source = table.source;
  report.measurements = fit.size();
  report.seconds = watch.seconds();

  const std::vector<TrackerMeasurement>& judged = validation.empty() ? fit : validation;
  const auto all_left = [](const TrackerCorrection& correction, const std::vector<TrackerMeasurement>& rows) {
    std::vector<Left> errors;
    for (const TrackerMeasurement& row : rows) errors.push_back(left_by(correction, row));
    return errors;
  };

  // On measurements that the fit of `asked` did not see; `whole` is the fit to all of them.
  const auto left_out = [&](const TrackerFitOptions& asked, const TrackerCorrection& whole) {
    if (!validation.empty()) return all_left(whole, validation);
    return left_out_errors(
        fit, options.folds,
        [&](const std::vector<TrackerMeasurement>& kept) { return fit_tracker(kept, asked, table.source); },
        left_by);
  };

  const std::vector<Left> before = all_left({}, judged);
  add_rows(report, "before", true, before);
  const std::vector<Left> seen = all_left(out.correction, fit);
  add_rows(report, name_of(options.method), false, seen);

  // Error beside time: every method, and polynomials of every degree that the measurements bear.
  for (const TrackerMethod method :
       {TrackerMethod::kPolynomial, TrackerMethod::kTable, TrackerMethod::kSpline, TrackerMethod::kCombined,
        TrackerMethod::kCombinedSpline, TrackerMethod::kDipoles, TrackerMethod::kCombinedDipoles}) {
    // A model of the metal takes as long as all others: it is compared where one was asked for.
    if (has_metal(method) && !has_metal(options.method)) continue;
    TrackerFitOptions asked = options;
    asked.method = method;
    const bool has_degree =
        method != TrackerMethod::kTable && method != TrackerMethod::kSpline && !has_metal(method);
    for (int degree = 1; degree <= 6; ++degree) {
      const bool sweep = method == TrackerMethod::kPolynomial;
      if (!sweep && degree != 1) break;
      asked.degree = sweep ? degree : options.degree;
      const std::size_t folds = validation.empty() ? options.folds : fit.size();
      const auto terms = as_size(has_degree ? term_count(asked.degree) : 0);
      if (fit.size() - (fit.size() + folds - 1) / folds <= terms) break;
      const TrackerCorrection whole = fit_tracker(fit, asked, table.source);
      const std::vector<Left> errors = left_out(asked, whole);
      if (!sweep || degree == options.degree) add_rows(report, name_of(method), true, errors);
      std::vector<double> position;
      for (const Left& e : errors) position.push_back(1e3 * e.position);
      report.work_precision.push_back(
          {.subject = "one corrected pose",
           .method = name_of(method),
           .parameter = has_degree ? "degree=" + std::to_string(asked.degree) : "",
           .error = statistics_of(position).mean,
           .error_kind = "mean position error [mm]",
           .seconds = evaluation_seconds(whole, judged)});
    }
  }

  const std::vector<Left> after = left_out(options, out.correction);
  require_betterment(before, after, table.source);
  std::vector<double> residuals;
  for (const Left& e : seen) residuals.push_back(e.position);
  constexpr double kNoOutlier = 1e-3;  // [m], what a tracker's noise may be
  for (const std::size_t row : outlying(residuals, kNoOutlier)) report.outliers.push_back(fit_rows[row - 1]);
  for (std::size_t i = 0; i < judged.size(); ++i) {
    const double distance = glm::length(judged[i].reported.position);
    report.position_errors.push_back({distance, before[i].position, after[i].position});
    report.orientation_errors.push_back({distance, before[i].orientation, after[i].orientation});
  }

  if (has_metal(options.method)) {
    describe_metal(report, made.metal);
    if (made.unread > 0)
      report.advice.push_back(
          counted(made.unread, "node") + " of " + std::to_string(out.correction.table.values.size()) +
          " of the table lie where nothing is read, and have the error of the measurement next "
          "to them");
  }
  if (out.correction.position.degree >= 0) {
    const PolynomialFit polynomial =
        fit_polynomials(samples_of(fit), options.degree, options.loss, table.source);
    const Identifiability found = analyze(polynomial.linearization);
    describe(report, found);
    require_identifiable(found, table.source, "spread the measurements more evenly through the volume");
    const TrackerCorrection alone{.position = polynomial.position, .orientation = polynomial.orientation};
    std::vector<double> left;
    for (const TrackerMeasurement& row : fit) left.push_back(left_by(alone, row).position);
    // Each axis has a polynomial of its own.
    const double sigma = residual_deviation(left, 3, 3 * polynomial.linearization.columns,
                                            options.loss != Loss::kSquare, kNoOutlier);
    for (std::size_t j = 0; j < polynomial.linearization.columns; ++j) {
      for (int axis = 0; axis < 3; ++axis)
        report.parameters.push_back({std::string("p") + "xyz"[axis] + " " + polynomial.linearization.names[j],
                                     polynomial.position.coefficients[j][axis],
                                     sigma * found.standard_deviations[j], "m"});
    }
  }
  return out;
}

}  // namespace palpate
