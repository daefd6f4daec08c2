/// What a tracker's table must not be, and what a correction must do: checks of tracker_fit.h.
#pragma once

#include <string>
#include <vector>

#include "common/calibration/measurements.h"
#include "common/kinematics/tracker_correction.h"

namespace palpate {

/// Position error [m] and angle [rad] that a correction leaves.
struct Left {
  double position = 0.0, orientation = 0.0;
};
[[nodiscard]] Left left_by(const TrackerCorrection& correction, const TrackerMeasurement& row);

/// Refuses a table that fits well once it is read another way. Metal bends a field by centimetres and some
/// degrees; errors beyond that are none of metal's. @throws Error (bad input) that names the slip.
void refuse_slips(const std::vector<TrackerMeasurement>& rows, const std::string& source);

/// Refuses a correction that corrects nothing, on measurements that it has not seen. @throws Error (work failed).
void require_betterment(const std::vector<Left>& before, const std::vector<Left>& after,
                        const std::string& source);

}  // namespace palpate
