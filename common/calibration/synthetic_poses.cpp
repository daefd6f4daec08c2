#include "common/calibration/synthetic_poses.h"

#include <cmath>
#include <random>

#include "common/calibration/synthetic_tracker.h"

namespace palpate {
namespace {

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
