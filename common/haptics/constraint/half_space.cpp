#include "common/haptics/constraint/half_space.h"

#include <algorithm>

#include "common/base/check.h"
#include "common/haptics/frame_along.h"

namespace palpate {

HalfSpaceConstraint::HalfSpaceConstraint(const Vec3& point, const Vec3& outward)
    : point_(point), axes_(frame_along(glm::normalize(outward))) {
  PALPATE_CHECK(glm::length(outward) > 0.0);
}

void HalfSpaceConstraint::update(const Vec3& probe, const UpdateBudget& /*budget*/,
                                 LinkUpdate& link) noexcept {
  const Vec3& outward = axes_[0];
  const double depth = std::min(0.0, glm::dot(probe - point_, outward));
  link.proxy = probe - depth * outward;
  link.frame = axes_;
  if (!(depth < 0.0)) return;
  link.state = HoldState::kHeld;
  link.jacobian = Mat3{1.0} - glm::outerProduct(outward, outward);
}

}  // namespace palpate
