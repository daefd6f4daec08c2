/// Made measurements for registrations, pivots and sightings, with the truth they were made from.
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "common/calibration/measurements.h"
#include "common/calibration/registration.h"
#include "common/kinematics/dhh_chain.h"

namespace palpate {

/// @tparam Row a kind of measurement; @tparam Truth what a fit should find.
template <typename Row, typename Truth>
struct Made {
  std::vector<Row> rows;
  Truth truth;
};

struct RegistrationTruth {
  Rigid instrument_from_pose;
  std::vector<Vec3> markers;
};

/// 20 poses near the transmitter, six markers about the sensor of which a camera sees those that face it:
/// three at least (Ikits 2006, sec. 4.2.4).
[[nodiscard]] Made<MarkerMeasurement, RegistrationTruth> synthetic_apparatus(std::uint64_t seed,
                                                                             const RegistrationNoise& noise);

/// 25 poses of an arm that carries a tracker's sensor: p and q are the arm's, the one marker is the sensor in
/// the tracker's frame (sec. 4.4).
[[nodiscard]] Made<MarkerMeasurement, RegistrationTruth> synthetic_coregistration(
    std::uint64_t seed, const RegistrationNoise& noise);

struct PivotTruth {
  Vec3 tip{0.0}, pivot{0.0};
};
/// 40 poses tilted by up to 45 degrees about a resting tip; 0.5 mm of noise an axis.
[[nodiscard]] Made<PivotMeasurement, PivotTruth> synthetic_pivot(std::uint64_t seed);

struct EyeTruth {
  Vec3 left{0.0}, right{0.0};
};
/// 15 sightings an eye with the head turned by up to 35 degrees; 0.5 mm of noise an axis.
[[nodiscard]] Made<SightingMeasurement, EyeTruth> synthetic_sightings(std::uint64_t seed);

// A made magnetic tracker whose readings metal distorts, as physics does it and not as a polynomial.
//
// The transmitter's three coils at the origin make dipole fields; with M(p) = (3 r r^T - 1) / |p|^3, r = p /
// |p|, a sensor at p sees S = R^T M(p). Each piece of metal at c is magnetized by the transmitter and adds
// a M(p - c) M(c), a its polarizability. The tracker reads S as if there were no metal: the direction from
// the major eigenvector of S^T S, the distance from its eigenvalue 4 / |p|^6, the rotation by what remains
// (after Raab et al. 1979).

struct SyntheticTracker {
  struct Metal {
    Vec3 place{0.0};              ///< c [m]
    double polarizability = 0.0;  ///< a [m^3]
  };
  std::vector<Metal> metal;
  double orientation_factor = 1.0;    ///< by which orientation errors are enlarged to match a given mean
  double position_noise = 0.7e-3;     ///< standard deviation an axis [m]
  double orientation_noise = 1.5e-3;  ///< likewise [rad]
  double instrument_noise = 0.15e-3;  ///< of the measured positions [m]

  /// What the tracker says without noise when the sensor is at `actual`.
  [[nodiscard]] TrackerPose reading(const TrackerPose& actual) const;
};

/// The workbench of Ikits 2006, sec. 4.2.5, as its text describes it: metal in the floor, a door and displays
/// in seeded places, scaled so that the mean errors are 42.3 mm and 4.72 degrees (table 4.1).
[[nodiscard]] SyntheticTracker synthetic_tracker(std::uint64_t seed);

/// 480 poses on four of every five nodes of a 12 x 10 x 5 grid of 0.15 m and 120 random ones for validation,
/// orientations random.
[[nodiscard]] std::vector<TrackerMeasurement> synthetic_tracker_measurements(const SyntheticTracker& tracker,
                                                                             std::uint64_t seed);

/// A rotation drawn evenly from all.
[[nodiscard]] Quat random_rotation(std::mt19937_64& random);

struct SyntheticArm {
  DhhChain nominal;  ///< what the maker says
  DhhChain actual;   ///< what it is
};

/// The arm of Ikits 2006, table 4.2, its joints' offsets wrong by some three degrees, the other angles by one
/// and lengths by a few millimetres; the offsets are scaled until its tip is 45 mm off on average.
[[nodiscard]] SyntheticArm synthetic_arm(std::uint64_t seed);

/// The tip put on an 8 x 5 grid of 5 inches and, if asked, on 20 points of a second grid nearly perpendicular
/// to it; the wrist turned at random; placed to 0.3 mm an axis, with readings of no error.
[[nodiscard]] std::vector<ArmMeasurement> synthetic_arm_measurements(const SyntheticArm& arm,
                                                                     bool second_grid, std::uint64_t seed);

}  // namespace palpate
