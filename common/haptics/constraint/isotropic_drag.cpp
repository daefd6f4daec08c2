#include "common/haptics/constraint/isotropic_drag.h"

#include "common/haptics/motion_rule.h"

namespace palpate {

void IsotropicDrag::update(const Vec3& probe, const UpdateBudget&, LinkUpdate& link) noexcept {
  if (!caught_) proxy_ = probe;
  caught_ = true;
  const Vec3 away = probe - proxy_;
  const JointDrag drag = drag_jointly(away, Vec3{tau_});
  link.jacobian = drag.jacobian;
  proxy_ += drag.moved;
  link.proxy = proxy_;
  link.state = HoldState::kHeld;
}

}  // namespace palpate
