/// A made magnetic tracker whose readings metal distorts, as physics does it and not as a polynomial.
///
/// The transmitter's three coils at the origin make dipole fields; with M(p) = (3 r r^T - 1) / |p|^3, r = p /
/// |p|, a sensor at p sees S = R^T M(p). Each piece of metal at c is magnetized by the transmitter and adds
/// a M(p - c) M(c), a its polarizability. The tracker reads S as if there were no metal: the direction from
/// the major eigenvector of S^T S, the distance from its eigenvalue 4 / |p|^6, the rotation by what remains
/// (after Raab et al. 1979).
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "common/calibration/measurements.h"

namespace palpate {

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

}  // namespace palpate
