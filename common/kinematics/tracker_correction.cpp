#include "common/kinematics/tracker_correction.h"

namespace palpate {

PoseError pose_error(const TrackerPose& actual, const TrackerPose& reported) noexcept {
  return {actual.position - reported.position,
          short_vector_part(actual.orientation * glm::conjugate(reported.orientation))};
}

PoseError TrackerCorrection::error_at(const Vec3& reported) const noexcept {
  PoseError error{position.at(reported), orientation.at(reported)};
  if (!table.values.empty()) error = error + table.at(reported);
  if (!spline.centers.empty()) error = error + spline.at(reported);
  return error;
}

TrackerPose TrackerCorrection::corrected(const TrackerPose& reported) const noexcept {
  const PoseError error = error_at(reported.position);
  return {reported.position + error.position,
          glm::normalize(rotation_with_vector_part(error.orientation) * reported.orientation)};
}

}  // namespace palpate
