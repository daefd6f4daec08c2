#include "common/kinematics/error_spline.h"

namespace palpate {

PoseError ErrorSpline::at(const Vec3& p) const noexcept {
  PoseError sum = plane[0] + p.x * plane[1] + p.y * plane[2] + p.z * plane[3];
  for (std::size_t i = 0; i < centers.size(); ++i) sum = sum + glm::distance(p, centers[i]) * weights[i];
  return sum;
}

}  // namespace palpate
