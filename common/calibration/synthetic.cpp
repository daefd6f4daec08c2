#include "common/calibration/synthetic.h"

#include <cmath>
#include <optional>
#include <random>

#include <Eigen/Dense>

#include "common/base/index.h"
#include "common/calibration/arm_fit.h"

namespace palpate {
namespace {

constexpr double kPlacing = 0.3e-3;      // [m] an axis
constexpr double kGridStep = 0.127;      // 5 inches
constexpr double kNominalError = 45e-3;  // [m]: Ikits 2006, sec. 4.3.3, says 30 to 60 mm
const std::vector<double> kRest{0.0, 0.5, 0.3, 0.0, 0.0, 0.0};  // the middle of the joints' range [rad]
// Before they are scaled to that:
constexpr double kOffsetError = 3.2 * kDegree;  // of joints, standard deviation
constexpr double kAngleError = 0.7 * kDegree;   // of other angles
constexpr double kLengthError = 4e-3;           // [m]

/// Readings of the first three joints that bring the tip to `target`, the wrist's being given: Newton from
/// the middle of the arm's range.
std::optional<std::vector<double>> reaching(const DhhChain& arm, const Vec3& target,
                                            std::vector<double> readings) {
  constexpr int kRounds = 60;
  constexpr double kThere = 1e-12, kStep = 1e-6, kMostTurn = 0.3;
  for (int round = 0; round < kRounds; ++round) {
    const Vec3 left = target - arm.forward(readings).translation;
    if (glm::length(left) < kThere) {
      constexpr double kRange = 2.0;  // [rad] from the middle
      for (int j = 0; j < 3; ++j) {
        if (std::abs(readings[as_size(j)]) > kRange) return std::nullopt;
      }
      return readings;
    }
    Mat3 jacobian{0.0};
    for (int j = 0; j < 3; ++j) {
      std::vector<double> above = readings, below = readings;
      above[as_size(j)] += kStep;
      below[as_size(j)] -= kStep;
      jacobian[j] = (arm.forward(above).translation - arm.forward(below).translation) / (2.0 * kStep);
    }
    constexpr double kSingular = 1e-6;
    if (std::abs(glm::determinant(jacobian)) < kSingular) return std::nullopt;
    Vec3 turn = glm::inverse(jacobian) * left;
    const double size = glm::length(turn);
    if (size > kMostTurn) turn *= kMostTurn / size;
    for (int j = 0; j < 3; ++j) readings[as_size(j)] += turn[j];
  }
  return std::nullopt;
}

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Mean errors before calibration (Ikits 2006, table 4.1).
constexpr double kMeanPosition = 42.3e-3, kMeanOrientation = 4.72 * kDegree;
// The grid of sec. 4.2.5 above and in front of the transmitter.
constexpr Index3 kNodes{12, 10, 5};
constexpr double kStep = 0.15;
const Vec3 kLower{-0.825, 0.15, -0.1};

Vector3d eigen(const Vec3& v) { return {v.x, v.y, v.z}; }

Matrix3d dipole(const Vec3& p) {
  const Vector3d r = eigen(glm::normalize(p));
  return (3.0 * r * r.transpose() - Matrix3d::Identity()) / std::pow(glm::length(p), 3);
}

Matrix3d matrix(const Quat& q) { return Eigen::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix(); }

std::vector<Vec3> grid() {
  std::vector<Vec3> out;
  for (int z = 0; z < kNodes.z; ++z) {
    for (int y = 0; y < kNodes.y; ++y) {
      for (int x = 0; x < kNodes.x; ++x) out.push_back(kLower + kStep * Vec3(x, y, z));
    }
  }
  return out;
}

double mean_error(const SyntheticTracker& tracker, bool orientation) {
  double sum = 0.0, count = 0.0;
  for (const Vec3& node : grid()) {
    // The middles of the grid's cells: its nodes alone would count the volume's border too much.
    const Vec3 p = node + Vec3{0.5 * kStep};
    const Vec3 upper = kLower + kStep * Vec3(kNodes - Index3{1});
    if (p.x > upper.x || p.y > upper.y || p.z > upper.z) continue;
    count += 1.0;
    const PoseError e = pose_error({p, identity_rotation()}, tracker.reading({p, identity_rotation()}));
    sum += orientation ? 2.0 * std::asin(std::min(1.0, glm::length(e.orientation))) : glm::length(e.position);
  }
  return sum / count;
}

/// Seeded draws in the order in which they are asked for.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : random_(seed) {}
  double within(double bound) { return bound * uniform_(random_); }
  Vec3 noise(double deviation) {
    const double x = normal_(random_), y = normal_(random_), z = normal_(random_);
    return deviation * Vec3{x, y, z};
  }
  Vec3 box(double bound) {
    const double x = within(bound), y = within(bound), z = within(bound);
    return {x, y, z};
  }
  Quat rotation() { return random_rotation(random_); }
  TrackerPose read(const TrackerPose& actual, double position, double orientation) {
    const Vec3 shift = noise(position), turn = noise(orientation);
    return {actual.position + shift, glm::normalize(rotation_by(turn) * actual.orientation)};
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
};

constexpr double kReadingNoise = 0.5e-3;  // [m], of pivots and sightings

}  // namespace

SyntheticArm synthetic_arm(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  // Beyond two deviations a maker would have noticed.
  const auto drawn = [&] {
    double value = normal(random);
    while (std::abs(value) > 2.0) value = normal(random);
    return value;
  };
  SyntheticArm out{nominal_phantom_3(), nominal_phantom_3()};
  for (DhhRow& row : out.actual.rows) {
    for (std::size_t q = 0; q < kDhhQuantities; ++q) {
      if (!row.free[q]) continue;
      const auto quantity = static_cast<DhhQuantity>(q);
      const bool length = quantity == DhhQuantity::kD || quantity == DhhQuantity::kA;
      const bool offset = row.joint >= 0 && quantity == DhhQuantity::kGamma;
      row.values[q] += drawn() * (length ? kLengthError : offset ? kOffsetError : kAngleError);
    }
  }
  // The joints' offsets by one factor, until the nominal arm is wrong by as much as the reference's was.
  std::vector<std::vector<double>> poses(200, kRest);
  for (auto& readings : poses) {
    for (double& reading : readings) reading += 0.5 * normal(random);
  }
  constexpr int kRounds = 12;  // offsets make most of the error
  for (int round = 0; round < kRounds; ++round) {
    double mean = 0.0;
    for (const auto& readings : poses) {
      mean +=
          glm::distance(out.actual.forward(readings).translation, out.nominal.forward(readings).translation) /
          static_cast<double>(poses.size());
    }
    for (const auto& [row, quantity] : offset_parameters(out.nominal)) {
      const auto r = as_size(row), q = as_size(quantity);
      const double nominal = out.nominal.rows[r].values[q];
      double& actual = out.actual.rows[r].values[q];
      actual = nominal + (actual - nominal) * kNominalError / mean;
    }
  }
  return out;
}

std::vector<ArmMeasurement> synthetic_arm_measurements(const SyntheticArm& arm, bool second_grid,
                                                       std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> within(-1.0, 1.0);
  // Where the arm's tip is with all joints in the middle of their range, projected on to the first grid's
  // plane.
  const Vec3 rest = arm.nominal.forward(kRest).translation;
  const Rigid upright{rotation_by({85.0 * kDegree, 0.0, 0.0}), {rest.x, rest.y - 0.1, -0.2}};
  std::vector<ArmMeasurement> out;
  const auto measure = [&](const Vec3& point, int grid) {
    const Vec3 noise{normal(random), normal(random), normal(random)};
    const Vec3 target = (grid > 0 ? upright * point : point) + kPlacing * noise;
    constexpr int kWrists = 20;
    for (int attempt = 0; attempt < kWrists; ++attempt) {
      std::vector<double> readings = kRest;
      readings[3] = 1.2 * within(random);
      readings[4] = 1.0 * within(random);
      readings[5] = 2.5 * within(random);
      if (auto found = reaching(arm.actual, target, readings)) {
        out.push_back({point, std::move(*found), grid});
        return;
      }
    }
  };
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 8; ++x)
      measure({rest.x + (x - 3.5) * kGridStep, rest.y - 0.1 + (y - 2) * kGridStep, 0.0}, 0);
  }
  for (int z = 0; second_grid && z < 4; ++z) {
    for (int x = 0; x < 5; ++x) measure({(x - 2) * kGridStep, z * kGridStep, 0.0}, 1);
  }
  return out;
}

Quat random_rotation(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return glm::normalize(Quat{w, x, y, z});
}

TrackerPose SyntheticTracker::reading(const TrackerPose& actual) const {
  Matrix3d field = dipole(actual.position);
  for (const Metal& piece : metal)
    field += piece.polarizability * dipole(actual.position - piece.place) * dipole(piece.place);
  const Matrix3d seen = matrix(actual.orientation).transpose() * field;

  const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(seen.transpose() * seen);
  Vector3d direction = axes.eigenvectors().col(2);
  // Both halves of space look alike to the coils; the tracker knows which one it works in.
  if (direction.dot(eigen(actual.position)) < 0.0) direction = -direction;
  const double distance = std::cbrt(2.0 / std::sqrt(axes.eigenvalues()(2)));
  const Vec3 position{distance * direction.x(), distance * direction.y(), distance * direction.z()};

  // S M^-1 is R^T but for what metal does to it: the nearest rotation.
  const Eigen::JacobiSVD<Matrix3d> svd(seen * dipole(position).inverse(),
                                       Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Quaterniond turned((svd.matrixU() * svd.matrixV().transpose()).transpose().eval());
  const Quat rotation{turned.w(), turned.x(), turned.y(), turned.z()};
  const Vec3 part = short_vector_part(rotation * glm::conjugate(actual.orientation));
  const double half = std::asin(std::min(1.0, glm::length(part)));
  const Vec3 turn = half > 0.0 ? 2.0 * half * orientation_factor * glm::normalize(part) : Vec3{0.0};
  return {position, glm::normalize(rotation_by(turn) * actual.orientation)};
}

SyntheticTracker synthetic_tracker(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> within(-1.0, 1.0);
  SyntheticTracker out;
  const auto add = [&](const Vec3& about, double spread, double strength) {
    const Vec3 shift{within(random), within(random), within(random)};
    out.metal.push_back({about + spread * shift, strength * (1.0 + 0.3 * within(random))});
  };
  // Bars in the floor 0.8 m below act from some way beneath its surface; larger things stand farther off.
  add({0.2, 0.35, -1.15}, 0.12, 1.0);
  add({-0.5, 0.65, -1.15}, 0.12, 0.7);
  add({2.2, 0.6, 0.2}, 0.1, 4.0);   // the door
  add({-2.1, 0.8, 0.3}, 0.1, 3.0);  // displays
  add({0.1, 2.4, 0.6}, 0.1, 3.0);
  // A mean grows with the polarizability nearly in proportion: a few rounds settle it.
  for (int round = 0; round < 12; ++round) {
    const double factor = kMeanPosition / mean_error(out, false);
    for (SyntheticTracker::Metal& piece : out.metal) piece.polarizability *= factor;
  }
  out.orientation_factor = kMeanOrientation / mean_error(out, true);
  return out;
}

std::vector<TrackerMeasurement> synthetic_tracker_measurements(const SyntheticTracker& tracker,
                                                               std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const auto noise = [&](double deviation) {
    const double x = normal(random), y = normal(random), z = normal(random);
    return deviation * Vec3{x, y, z};
  };
  std::vector<TrackerMeasurement> out;
  const auto measure = [&](const Vec3& place, bool validation) {
    const TrackerPose actual{place, random_rotation(random)};
    TrackerPose reported = tracker.reading(actual);
    reported.position += noise(tracker.position_noise);
    reported.orientation =
        glm::normalize(rotation_by(noise(tracker.orientation_noise)) * reported.orientation);
    out.push_back({reported, {place + noise(tracker.instrument_noise), actual.orientation}, validation});
  };
  // Nobody puts a sensor on the grid's very nodes: a few millimetres beside them.
  constexpr double kPlacing = 5e-3;
  // Of every five nodes the reference kept four.
  const std::vector<Vec3> nodes = grid();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (i % 5 != 4) measure(nodes[i] + noise(kPlacing), false);
  }
  const Vec3 size = kStep * Vec3(kNodes - Index3{1});
  for (int i = 0; i < 120; ++i) {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    measure(kLower + Vec3{x, y, z} * size, true);
  }
  return out;
}

Made<MarkerMeasurement, RegistrationTruth> synthetic_apparatus(std::uint64_t seed,
                                                               const RegistrationNoise& noise) {
  Draws draws(seed);
  Made<MarkerMeasurement, RegistrationTruth> out;
  out.truth.instrument_from_pose = {draws.rotation(), Vec3{0.3, -0.2, -2.5} + draws.box(0.2)};
  for (std::size_t m = 0; m < kMaxMarkers; ++m) {
    Vec3 place{0.0};
    place[static_cast<int>(m / 2)] = m % 2 == 0 ? 0.12 : -0.12;
    out.truth.markers.push_back(place + draws.box(0.01));
  }
  const Rigid& to = out.truth.instrument_from_pose;
  while (out.rows.size() < 20) {
    const TrackerPose actual{Vec3{0.0, 0.35, 0.1} + draws.box(0.2), draws.rotation()};
    MarkerMeasurement row{.pose = draws.read(actual, noise.pose_position, noise.pose_orientation),
                          .markers = {}};
    int seen = 0;
    for (std::size_t m = 0; m < kMaxMarkers; ++m) {
      const Vec3 arm = actual.orientation * out.truth.markers[m];
      const Vec3 place = to * (actual.position + arm);
      // Markers on the camera's side of the platform are seen; it stands at the instrument's origin.
      if (glm::dot(to.rotation * arm, -place) <= 0.0) continue;
      row.markers[m] = place + draws.noise(noise.marker);
      ++seen;
    }
    if (seen >= 3) out.rows.push_back(row);
  }
  return out;
}

Made<MarkerMeasurement, RegistrationTruth> synthetic_coregistration(std::uint64_t seed,
                                                                    const RegistrationNoise& noise) {
  Draws draws(seed);
  Made<MarkerMeasurement, RegistrationTruth> out;
  out.truth = {{draws.rotation(), draws.box(0.8)}, {Vec3{0.02, -0.03, 0.15} + draws.box(0.01)}};
  for (int i = 0; i < 25; ++i) {
    const Vec3 tilt = draws.box(0.9);
    const TrackerPose actual{Vec3{0.4, 0.1, 0.3} + draws.box(0.25), rotation_by(tilt)};
    MarkerMeasurement row{.pose = draws.read(actual, noise.pose_position, noise.pose_orientation),
                          .markers = {}};
    row.markers[0] =
        out.truth.instrument_from_pose * (actual.position + actual.orientation * out.truth.markers[0]) +
        draws.noise(noise.marker);
    out.rows.push_back(row);
  }
  return out;
}

Made<PivotMeasurement, PivotTruth> synthetic_pivot(std::uint64_t seed) {
  Draws draws(seed);
  Made<PivotMeasurement, PivotTruth> out;
  out.truth = {Vec3{0.01, 0.0, -0.14} + draws.box(0.01), Vec3{0.2, 0.4, 0.1} + draws.box(0.1)};
  for (int i = 0; i < 40; ++i) {
    const double tilt_x = draws.within(0.8), tilt_y = draws.within(0.8), turn = draws.within(3.0);
    const Quat q = rotation_by({tilt_x, tilt_y, 0.0}) * rotation_by({0.0, 0.0, turn});
    const TrackerPose actual{out.truth.pivot - q * out.truth.tip, q};
    out.rows.push_back(draws.read(actual, kReadingNoise, 0.0));
  }
  return out;
}

Made<SightingMeasurement, EyeTruth> synthetic_sightings(std::uint64_t seed) {
  Draws draws(seed);
  Made<SightingMeasurement, EyeTruth> out;
  // The sensor sits on a head band: eyes lie in front of it and below, x to the right, y up, z back.
  const Vec3 middle = Vec3{0.0, -0.09, -0.10} + draws.box(0.01);
  const double half = 0.0315 + draws.within(0.002);
  out.truth = {middle - Vec3{half, 0.0, 0.0}, middle + Vec3{half, 0.0, 0.0}};
  for (int i = 0; i < 30; ++i) {
    const bool right = i % 2 == 1;
    const Quat q = rotation_by(draws.box(0.6));
    const TrackerPose actual{Vec3{0.0, 0.6, 0.7} + draws.box(0.1), q};
    const Vec3 eye = actual.position + q * (right ? out.truth.right : out.truth.left);
    const Vec3 far = Vec3{0.0, 0.1, -0.3} + draws.box(0.3);
    const Vec3 near = eye + 0.35 * (far - eye);
    out.rows.push_back({draws.read(actual, kReadingNoise, 0.0), right, near, far});
  }
  return out;
}

}  // namespace palpate
