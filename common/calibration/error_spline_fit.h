/// The spline of errors at scattered places, for tracker_fit.cpp.
#pragma once

#include <vector>

#include <Eigen/Dense>

#include "common/kinematics/tracker_correction.h"

namespace palpate {

/// An error of six numbers: position, orientation.
[[nodiscard]] inline PoseError pose_error_of(const Eigen::VectorXd& six) {
  return {{six(0), six(1), six(2)}, {six(3), six(4), six(5)}};
}

[[nodiscard]] Box box_of(const std::vector<Vec3>& places);

/// The spline through what is left of the errors, smoothed by the weight that predicts a left-out one best.
/// @param all_errors N x 6. Without centres where it cannot be solved.
[[nodiscard]] ErrorSpline fit_spline(const std::vector<Vec3>& all_places, const Eigen::MatrixXd& all_errors);

}  // namespace palpate
