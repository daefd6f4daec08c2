#include "common/calibration/synthetic_tracker.h"

#include <cmath>

#include <Eigen/Dense>

namespace palpate {
namespace {

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

}  // namespace

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

}  // namespace palpate
