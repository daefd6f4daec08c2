#include "common/calibration/registration.h"

#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {
namespace {

struct Estimate {
  Rigid instrument_from_pose;
  std::array<Vec3, kMaxMarkers> markers{};
};

std::array<bool, kMaxMarkers> seen_markers(const std::vector<MarkerMeasurement>& rows) {
  std::array<bool, kMaxMarkers> seen{};
  for (const MarkerMeasurement& row : rows) {
    for (std::size_t m = 0; m < kMaxMarkers; ++m) seen[m] = seen[m] || row.markers[m].has_value();
  }
  return seen;
}

Vec3 predicted(const Estimate& e, const TrackerPose& pose, std::size_t marker) {
  return e.instrument_from_pose * (pose.position + pose.orientation * e.markers[marker]);
}

/// Root mean square of (1)'s residuals with the poses taken as read.
double misfit(const Estimate& e, const std::vector<MarkerMeasurement>& rows) {
  double squares = 0.0, count = 0.0;
  for (const MarkerMeasurement& row : rows) {
    for (std::size_t m = 0; m < kMaxMarkers; ++m) {
      if (!row.markers[m]) continue;
      const Vec3 left = *row.markers[m] - predicted(e, row.pose, m);
      squares += glm::dot(left, left);
      count += 1.0;
    }
  }
  return std::sqrt(squares / count);
}

/// For a given q_0, markers and then p_0, q_0 by turns: each is the mean or the alignment of the others.
void alternate(Estimate& e, const std::vector<MarkerMeasurement>& rows) {
  // Few rounds tell starts apart; least squares finishes the work.
  constexpr int kRounds = 40;
  for (int round = 0; round < kRounds; ++round) {
    const Rigid pose_from_instrument = e.instrument_from_pose.inverse();
    std::array<Vec3, kMaxMarkers> sum{};
    std::array<double, kMaxMarkers> count{};
    for (const MarkerMeasurement& row : rows) {
      for (std::size_t m = 0; m < kMaxMarkers; ++m) {
        if (!row.markers[m]) continue;
        sum[m] += glm::conjugate(row.pose.orientation) *
                  (pose_from_instrument * *row.markers[m] - row.pose.position);
        count[m] += 1.0;
      }
    }
    for (std::size_t m = 0; m < kMaxMarkers; ++m) {
      if (count[m] > 0.0) e.markers[m] = sum[m] / count[m];
    }
    std::vector<Vec3> model, measured;
    for (const MarkerMeasurement& row : rows) {
      for (std::size_t m = 0; m < kMaxMarkers; ++m) {
        if (!row.markers[m]) continue;
        model.push_back(row.pose.position + row.pose.orientation * e.markers[m]);
        measured.push_back(*row.markers[m]);
      }
    }
    const auto aligned = align_points(model, measured);
    if (!aligned) return;
    e.instrument_from_pose = aligned->to_from_from;
  }
}

/// The best of alternations that start from the 24 turns of a cube: no other place is far from one of them.
Estimate first_estimate(const std::vector<MarkerMeasurement>& rows) {
  Estimate best;
  double least = std::numeric_limits<double>::infinity();
  const double h = std::sqrt(0.5);
  const std::array<Quat, 6> faces{Quat{1, 0, 0, 0},  Quat{h, h, 0, 0}, Quat{0, 1, 0, 0},
                                  Quat{h, -h, 0, 0}, Quat{h, 0, h, 0}, Quat{h, 0, -h, 0}};
  const std::array<Quat, 4> turns{Quat{1, 0, 0, 0}, Quat{h, 0, 0, h}, Quat{0, 0, 0, 1}, Quat{h, 0, 0, -h}};
  for (const Quat& face : faces) {
    for (const Quat& turn : turns) {
      Estimate e;
      e.instrument_from_pose.rotation = face * turn;
      // With the markers at first in the sensor's own place, p_0 is a difference of means.
      Vec3 sum{0.0};
      double count = 0.0;
      for (const MarkerMeasurement& row : rows) {
        for (const auto& marker : row.markers) {
          if (!marker) continue;
          sum += *marker - e.instrument_from_pose.rotation * row.pose.position;
          count += 1.0;
        }
      }
      e.instrument_from_pose.translation = sum / count;
      alternate(e, rows);
      const double error = misfit(e, rows);
      if (error < least) {
        least = error;
        best = e;
      }
    }
  }
  return best;
}

std::array<double, 3> numbers(const Vec3& x) { return {x.x, x.y, x.z}; }
Quat quaternion(const double* x) { return glm::normalize(Quat{x[0], x[1], x[2], x[3]}); }

ParameterBlock position_block(const std::string& name, const Vec3& x) {
  const auto [a, b, c] = numbers(x);
  return {.values = {a, b, c}, .names = {name + ".x", name + ".y", name + ".z"}};
}

ParameterBlock rotation_block(const std::string& name, const Quat& q) {
  return {
      .values = {q.w, q.x, q.y, q.z}, .names = {name + ".1", name + ".2", name + ".3"}, .quaternion = true};
}

/// The problem of total least squares: the asked parameters first, then each measurement's pose.
struct Problem {
  LeastSquaresProblem least_squares;
  std::array<std::size_t, kMaxMarkers> marker_block{};
  std::size_t asked = 0;  ///< degrees of freedom of the blocks that are asked for
};

Problem posed(const std::vector<MarkerMeasurement>& rows, const Estimate& start,
              const RegistrationNoise& noise) {
  Problem out;
  LeastSquaresProblem& p = out.least_squares;
  p.parameters = {position_block("p0", start.instrument_from_pose.translation),
                  rotation_block("q0", start.instrument_from_pose.rotation)};
  const auto seen = seen_markers(rows);
  for (std::size_t m = 0; m < kMaxMarkers; ++m) {
    if (!seen[m]) continue;
    out.marker_block[m] = p.parameters.size();
    p.parameters.push_back(position_block("r" + std::to_string(m + 1), start.markers[m]));
  }
  out.asked = 3 * p.parameters.size();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const TrackerPose read = rows[i].pose;
    const std::size_t position = p.parameters.size(), rotation = position + 1;
    p.parameters.push_back(position_block("p of row " + std::to_string(i + 1), read.position));
    p.parameters.push_back(rotation_block("q of row " + std::to_string(i + 1), read.orientation));
    p.residuals.push_back({.parameters = {position},
                           .dimension = 3,
                           .evaluate =
                               [read, noise](const double* const* x, double* r) {
                                 write_residuals(r, (vector(x[0]) - read.position) / noise.pose_position);
                               },
                           .robust = false});
    p.residuals.push_back({.parameters = {rotation},
                           .dimension = 3,
                           .evaluate =
                               [read, noise](const double* const* x, double* r) {
                                 const Quat left = quaternion(x[0]) * glm::conjugate(read.orientation);
                                 write_residuals(r, 2.0 * short_vector_part(left) / noise.pose_orientation);
                               },
                           .robust = false});
    for (std::size_t m = 0; m < kMaxMarkers; ++m) {
      if (!rows[i].markers[m]) continue;
      p.residuals.push_back({.parameters = {0, 1, out.marker_block[m], position, rotation},
                             .dimension = 3,
                             .evaluate = [v = *rows[i].markers[m], noise](const double* const* x, double* r) {
                               const Vec3 inside = vector(x[3]) + quaternion(x[4]) * vector(x[2]);
                               write_residuals(r,
                                               (v - vector(x[0]) - quaternion(x[1]) * inside) / noise.marker);
                             }});
    }
  }
  return out;
}

Estimate estimate_of(const Problem& problem) {
  const auto& blocks = problem.least_squares.parameters;
  Estimate out;
  out.instrument_from_pose = {quaternion(blocks[1].values.data()), vector(blocks[0].values.data())};
  for (std::size_t m = 0; m < kMaxMarkers; ++m) {
    if (problem.marker_block[m]) out.markers[m] = vector(blocks[problem.marker_block[m]].values.data());
  }
  return out;
}

void require_enough(const std::vector<MarkerMeasurement>& rows, const std::string& source) {
  std::size_t points = 0;
  for (const MarkerMeasurement& row : rows) {
    for (const auto& marker : row.markers) points += marker ? 1 : 0;
  }
  std::size_t unknowns = 6;
  for (const bool seen : seen_markers(rows)) unknowns += seen ? 3 : 0;
  // Three poses are the least that fix a motion and a point in the moving frame.
  if (rows.size() >= 4 && 3 * points > unknowns) return;
  throw input_error({.file = source,
                     .place = "",
                     .found = counted(rows.size(), "measurement") + " with " + counted(points, "seen point") +
                              " for " + std::to_string(unknowns) + " unknowns",
                     .expected = "four measurements at least",
                     .remedy = "measure more poses, turned about different axes"});
}

struct Solved {
  Estimate estimate;
  Problem problem;
  LeastSquaresSummary summary;
};

Solved solve(const std::vector<MarkerMeasurement>& rows, const RegistrationOptions& options) {
  Solved out;
  const Estimate start = first_estimate(rows);
  out.problem = posed(rows, start, options.noise);
  // Residuals are in deviations: Huber's 1.345 for a vector of three.
  out.summary = minimize(out.problem.least_squares, {.loss = options.loss, .loss_scale = 2.33});
  out.estimate = estimate_of(out.problem);
  return out;
}

/// Mean distance [m] between where a row's markers were seen and where its pose as read puts them.
double row_error(const Estimate& e, const MarkerMeasurement& row) {
  double sum = 0.0, count = 0.0;
  for (std::size_t m = 0; m < kMaxMarkers; ++m) {
    if (!row.markers[m]) continue;
    sum += glm::distance(*row.markers[m], predicted(e, row.pose, m));
    count += 1.0;
  }
  return count > 0.0 ? sum / count : 0.0;
}

}  // namespace

std::optional<PointAlignment> align_points(std::span<const Vec3> model, std::span<const Vec3> measured) {
  PALPATE_CHECK(model.size() == measured.size());
  if (model.size() < 3) return std::nullopt;
  const double n = static_cast<double>(model.size());
  Vec3 from{0.0}, to{0.0};
  for (std::size_t i = 0; i < model.size(); ++i) {
    from += model[i] / n;
    to += measured[i] / n;
  }
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero(), spread = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < model.size(); ++i) {
    const Vec3 a = model[i] - from, b = measured[i] - to;
    const Eigen::Vector3d ea(a.x, a.y, a.z), eb(b.x, b.y, b.z);
    cross += eb * ea.transpose();
    spread += ea * ea.transpose() / n;
  }
  const Eigen::Vector3d widths =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues().cwiseMax(0.0).cwiseSqrt();
  // A line of points leaves the turn about it open; so thin a triangle gives only noise for it.
  constexpr double kThin = 1e-3;
  if (!(widths(1) > kThin * widths(2))) return std::nullopt;

  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1.0, 1.0, 1.0);
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0) signs(2) = -1.0;
  const Eigen::Matrix3d rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  const Eigen::Quaterniond q(rotation);
  PointAlignment out;
  out.to_from_from.rotation = glm::normalize(Quat{q.w(), q.x(), q.y(), q.z()});
  out.to_from_from.translation = to - out.to_from_from.rotation * from;
  out.width = widths(1);
  double squares = 0.0;
  for (std::size_t i = 0; i < model.size(); ++i) {
    const Vec3 left = measured[i] - out.to_from_from * model[i];
    squares += glm::dot(left, left) / n;
  }
  out.rms = std::sqrt(squares);
  return out;
}

Registration calibrate_registration(const MeasurementTable<MarkerMeasurement>& table, RegistrationKind kind,
                                    const RegistrationOptions& options) {
  const Stopwatch watch;
  require_enough(table.rows, table.source);
  const Solved solved = solve(table.rows, options);

  Registration out;
  FitReport& report = out.report;
  report.kind = kind == RegistrationKind::kApparatus ? "apparatus" : "coregistration";
  report.source = table.source;
  report.measurements = table.rows.size();
  report.iterations = solved.summary.iterations;
  const Linearization linear = linearize(solved.problem.least_squares);
  const Identifiability found = analyze(linear, solved.problem.asked);
  require_identifiable(found, table.source,
                       "measure poses that turn about two axes at least, by 30 degrees and more, at places "
                       "well apart");
  describe(report, found);
  report.seconds = watch.seconds();

  double chi_square = 0.0;
  for (const double r : linear.residuals) chi_square += r * r;
  report.chi_square = chi_square;
  report.degrees_of_freedom = linear.rows - linear.columns;
  report.chi_square_probability = chi_square_tail(chi_square, report.degrees_of_freedom);

  out.instrument_from_pose = solved.estimate.instrument_from_pose;
  const auto seen = seen_markers(table.rows);
  for (std::size_t m = 0; m < kMaxMarkers; ++m) {
    if (!seen[m]) continue;
    out.markers.resize(m + 1, Vec3{0.0});
    out.seen.resize(m + 1, false);
    out.markers[m] = solved.estimate.markers[m];
    out.seen[m] = true;
  }
  std::size_t column = 0;
  for (const ParameterBlock& block : solved.problem.least_squares.parameters) {
    if (column >= solved.problem.asked) break;
    if (block.quaternion) {
      // Three of four components are free; their deviations are in the order of the smallest three.
      std::size_t largest = 0;
      for (std::size_t i = 1; i < 4; ++i) {
        if (std::abs(block.values[i]) > std::abs(block.values[largest])) largest = i;
      }
      std::size_t free = column;
      for (std::size_t i = 0; i < 4; ++i) {
        const double deviation =
            i == largest ? std::numeric_limits<double>::quiet_NaN() : found.standard_deviations[free++];
        report.parameters.push_back({std::string("q0.") + "wxyz"[i], block.values[i], deviation, "1"});
      }
    } else {
      for (std::size_t i = 0; i < 3; ++i)
        report.parameters.push_back(
            {block.names[i], block.values[i], found.standard_deviations[column + i], "m"});
    }
    column += 3;
  }

  std::vector<double> residuals;
  for (const MarkerMeasurement& row : table.rows) residuals.push_back(row_error(solved.estimate, row));
  report.errors.push_back(distance_row("fitted", false, residuals));
  report.outliers = outlying(residuals, 3.0 * options.noise.pose_position);
  if (table.rows.size() >= 2 * options.folds) {
    report.errors.push_back(distance_row(
        "fitted", true,
        left_out_errors(
            table.rows, options.folds,
            [&](const std::vector<MarkerMeasurement>& kept) { return solve(kept, options).estimate; },
            row_error)));
  }
  constexpr double kUnlikely = 0.001;
  if (options.loss == Loss::kSquare && report.chi_square_probability < kUnlikely) {
    report.advice.push_back(
        "chi-square is too large for the noise that was assumed: look at the outliers, or "
        "state larger deviations");
  }
  return out;
}

}  // namespace palpate
