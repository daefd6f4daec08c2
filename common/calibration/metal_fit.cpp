#include "common/calibration/metal_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

// What counts as one in residuals: about a tracker's noise.
constexpr double kPosition = 1e-3;  // [m]
constexpr double kTurn = 2e-3;      // of a vector part

Mat3 dipole_matrix(const Vec3& p) noexcept {
  const double square = glm::dot(p, p);
  const double length = std::sqrt(square);
  return (glm::outerProduct(p, p) * (3.0 / square) - Mat3{1.0}) / (square * length);
}

/// The part of F that a source of unit strength adds at p.
Mat3 answer_of(const MetalSource& source, const Vec3& p) noexcept {
  if (source.kind == MetalSource::Kind::kPiece)
    return dipole_matrix(p - source.place) * dipole_matrix(source.place);
  const Vec3 n = glm::normalize(source.place);
  return dipole_matrix(p - 2.0 * source.place) * (Mat3{1.0} - 2.0 * glm::outerProduct(n, n));
}

/// The rotation next to `a` (Higham 1986): Newton's iteration for its polar factor.
Mat3 nearest_rotation(Mat3 a) noexcept {
  const double size = std::cbrt(std::abs(glm::determinant(a)));
  a /= size;
  constexpr int kRounds = 20;
  for (int round = 0; round < kRounds; ++round) {
    const Mat3 next = 0.5 * (a + glm::transpose(glm::inverse(a)));
    const Mat3 change = next - a;
    a = next;
    constexpr double kSettled = 1e-24;
    if (glm::dot(change[0], change[0]) + glm::dot(change[1], change[1]) + glm::dot(change[2], change[2]) <
        kSettled)
      break;
  }
  return a;
}

/// Six residuals of a row under a model.
void residuals_of(const TrackerMeasurement& row, const MetalModel& model, double* out) {
  const PoseError seen = pose_error(row.actual, row.reported);
  const PoseError made = model.error_of(row.actual.position);
  write_residuals(out, (seen.position - made.position) / kPosition);
  write_residuals(out + 3, (seen.orientation - made.orientation) / kTurn);
}

double square_of(const TrackerMeasurement& row, const MetalModel& model) {
  double six[6] = {};
  residuals_of(row, model, six);
  double sum = 0.0;
  for (const double r : six) sum += r * r;
  return std::isfinite(sum) ? sum : std::numeric_limits<double>::max();
}

/// The square that nine of ten rows stay below: where it is steep the model has to be right, too, and gross errors say
/// nothing.
double usual_miss(const std::vector<TrackerMeasurement>& rows, const MetalModel& model) {
  std::vector<double> squares;
  for (const TrackerMeasurement& row : rows) squares.push_back(square_of(row, model));
  const auto at = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() * 9 / 10);
  std::nth_element(squares.begin(), at, squares.end());
  return *at;
}

/// All parameters of `model`, fitted to `rows` from where they are.
MetalModel refined(const MetalModel& model, const std::vector<TrackerMeasurement>& rows, Loss loss,
                   int rounds) {
  LeastSquaresProblem problem;
  ParameterBlock block{.values = {model.turn_factor}, .names = {"turn factor"}};
  // Strengths in parts of the cube of their distance, so that all numbers are near one.
  for (const MetalSource& source : model.sources) {
    const double unit =
        source.kind == MetalSource::Kind::kPiece ? std::pow(glm::length(source.place), 3) : 1.0;
    for (int axis = 0; axis < 3; ++axis) block.values.push_back(source.place[axis]);
    block.values.push_back(source.strength / unit);
    for (const char* const name : {"x", "y", "z", "strength"}) block.names.emplace_back(name);
  }
  problem.parameters.push_back(block);
  const auto model_of = [&model](const double* x) {
    MetalModel made{model.sources, x[0]};
    for (std::size_t s = 0; s < made.sources.size(); ++s) {
      MetalSource& source = made.sources[s];
      source.place = vector(x + 1 + 4 * s);
      const double unit =
          source.kind == MetalSource::Kind::kPiece ? std::pow(glm::length(source.place), 3) : 1.0;
      source.strength = x[4 + 4 * s] * unit;
    }
    return made;
  };
  // One block a row, so that a loss looks at each measurement.
  for (const TrackerMeasurement& row : rows) {
    problem.residuals.push_back({.parameters = {0},
                                 .dimension = 6,
                                 .evaluate = [&row, &model_of](const double* const* x, double* out) {
                                   residuals_of(row, model_of(x[0]), out);
                                 }});
  }
  constexpr double kLossScale = 4.0;
  (void)minimize(problem, {.loss = loss, .loss_scale = kLossScale, .max_iterations = rounds});
  return model_of(problem.parameters[0].values.data());
}

/// `every`-th rows.
std::vector<TrackerMeasurement> thinned(const std::vector<TrackerMeasurement>& rows, std::size_t most) {
  const std::size_t stride = (rows.size() + most - 1) / most;
  std::vector<TrackerMeasurement> out;
  for (std::size_t i = 0; i < rows.size(); i += stride) out.push_back(rows[i]);
  return out;
}

/// The source of a lattice about the measurements that explains most of what `model` leaves, with its best strength.
MetalSource best_candidate(const MetalModel& model, const std::vector<TrackerMeasurement>& rows) {
  Box box;
  for (const TrackerMeasurement& row : rows) box.include(row.actual.position);
  box.include(Vec3{0.0});
  const Vec3 middle = box.center(), half = glm::max(0.5 * box.size(), Vec3{0.2 * box.diagonal()});
  std::vector<double> left(6 * rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) residuals_of(rows[i], model, &left[6 * i]);
  const auto plain_squares = [&rows, &model] {
    std::vector<PoseError> out;
    for (const TrackerMeasurement& row : rows) out.push_back(model.error_of(row.actual.position));
    return out;
  };
  const std::vector<PoseError> now = plain_squares();
  MetalSource best;
  double most = -1.0;
  const auto consider = [&](MetalSource source) {
    const double distance = glm::length(source.place);
    // As near the coils or a sensor, a point is no model of a piece of metal.
    constexpr double kNear = 0.2;  // [m]
    if (distance < kNear) return;
    if (source.kind == MetalSource::Kind::kPiece) {
      for (const TrackerMeasurement& row : rows) {
        if (glm::distance(row.actual.position, source.place) < 0.5 * kNear) return;
      }
    }
    // A weak one changes readings in proportion to its strength.
    const double weak = source.kind == MetalSource::Kind::kPiece ? 1e-3 * std::pow(distance, 3) : 1e-3;
    MetalModel with = model;
    with.sources.push_back(source);
    with.sources.back().strength = weak;
    double along = 0.0, square = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const PoseError e = with.error_of(rows[i].actual.position);
      const Vec3 p = (e.position - now[i].position) / kPosition,
                 q = (e.orientation - now[i].orientation) / kTurn;
      const Vec3 lp = vector(&left[6 * i]), lq = vector(&left[6 * i + 3]);
      // Far off rows count less, as a robust loss has it.
      const double weight = 1.0 / (1.0 + 1e-4 * (glm::dot(lp, lp) + glm::dot(lq, lq)));
      along += weight * (glm::dot(p, lp) + glm::dot(q, lq));
      square += weight * (glm::dot(p, p) + glm::dot(q, q));
    }
    const double gain = square > 0.0 ? along * along / square : 0.0;
    if (!std::isfinite(gain) || gain <= most) return;
    most = gain;
    best = source;
    best.strength = weak * along / square;
  };
  constexpr int kSide = 4;  // to either side of the middle, out to twice the box
  for (int z = -kSide; z <= kSide; ++z) {
    for (int y = -kSide; y <= kSide; ++y) {
      for (int x = -kSide; x <= kSide; ++x)
        consider({MetalSource::Kind::kPiece, middle + 2.0 / kSide * Vec3(x, y, z) * half});
    }
  }
  // Sheets on all sides, beyond the sensors.
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      for (const double beyond : {0.2, 0.6, 1.2}) {
        Vec3 place{0.0};
        place[axis] = (side < 0.0 ? box.lower[axis] : box.upper[axis]) + side * beyond;
        consider({MetalSource::Kind::kSheet, place});
      }
    }
  }
  return best;
}

}  // namespace

Mat3 MetalModel::field_at(const Vec3& p) const noexcept {
  Mat3 field = dipole_matrix(p);
  for (const MetalSource& source : sources) field += source.strength * answer_of(source, p);
  return field;
}

PoseError MetalModel::error_of(const Vec3& actual) const noexcept {
  const Mat3 field = field_at(actual);
  // In units of the field without metal: eigenvalues near one and four at any distance.
  const double distance = glm::length(actual);
  const Mat3 scaled = field * (distance * distance * distance);
  const SymmetricEigen axes = symmetric_eigen(glm::transpose(scaled) * scaled);
  Vec3 direction = axes.vectors[0];
  if (glm::dot(direction, actual) < 0.0) direction = -direction;
  const Vec3 read = distance * std::cbrt(2.0 / std::sqrt(axes.values.x)) * direction;
  const Quat turn = glm::quat_cast(nearest_rotation(field * glm::inverse(dipole_matrix(read))));
  return {actual - read, turn_factor * short_vector_part(turn)};
}

PoseError MetalModel::error_at(const Vec3& reported) const noexcept {
  // So near the coils no metal is heard.
  constexpr double kNear = 0.02;  // [m]
  if (glm::length(reported) < kNear) return {};
  // Newton's method for the place that is read as this one.
  Vec3 actual = reported;
  constexpr int kRounds = 30;
  constexpr double kThere = 1e-8, kStep = 1e-5, kLeap = 0.2;  // [m]
  for (int round = 0; round < kRounds; ++round) {
    const PoseError error = error_of(actual);
    Mat3 slope{1.0};
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 beside{0.0};
      beside[axis] = kStep;
      slope[axis] -=
          (error_of(actual + beside).position - error_of(actual - beside).position) / (2.0 * kStep);
    }
    Vec3 change = glm::inverse(slope) * (reported + error.position - actual);
    const double length = glm::length(change);
    if (length < kThere) return error;
    if (length > kLeap) change *= kLeap / length;
    actual += change;
  }
  const Vec3 none{std::numeric_limits<double>::quiet_NaN()};
  return {none, none};
}

MetalModel fit_metal(const std::vector<TrackerMeasurement>& rows, Loss loss, const std::string& source) {
  constexpr std::size_t kFewest = 20;
  if (rows.size() < kFewest)
    throw input_error({source, "", counted(rows.size(), "measurement") + " for a model of the metal",
                       std::to_string(kFewest) + " at least",
                       "measure on a grid through the tracked volume"});
  // Of every five rows one tells whether a further source is any good.
  std::vector<TrackerMeasurement> used, apart;
  for (std::size_t i = 0; i < rows.size(); ++i) (i % 5 == 2 ? apart : used).push_back(rows[i]);
  constexpr std::size_t kSearched = 120;  // rows carry the search, all of them the fit
  const std::vector<TrackerMeasurement> few = thinned(used, kSearched);
  MetalModel best;
  double least = usual_miss(apart, best);
  for (int n = 0; n < kMostSources && rows.size() > as_size(4 * (n + 1)); ++n) {
    MetalModel more = best;
    more.sources.push_back(best_candidate(more, few));
    constexpr int kSearchRounds = 40;
    more = refined(more, few, loss, kSearchRounds);
    const double miss = usual_miss(apart, more);
    constexpr double kWorthIt = 0.97;
    if (!(miss < kWorthIt * least)) break;
    least = miss;
    best = std::move(more);
  }
  constexpr int kLastRounds = 60;
  return refined(best, rows, loss, kLastRounds);
}

}  // namespace palpate
