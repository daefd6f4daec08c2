/// A made arm that differs from its nominal model, and a lab's measurements of it.
#pragma once

#include <cstdint>
#include <vector>

#include "common/calibration/measurements.h"
#include "common/kinematics/dhh_chain.h"

namespace palpate {

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
