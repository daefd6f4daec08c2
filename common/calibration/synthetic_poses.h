/// Made measurements for registrations, pivots and sightings, with the truth they were made from.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/calibration/measurements.h"
#include "common/calibration/registration.h"

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

}  // namespace palpate
