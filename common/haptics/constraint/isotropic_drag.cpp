#include "common/haptics/constraint/isotropic_drag.h"

#include "common/haptics/motion_rule.h"

namespace palpate {

void IsotropicDrag::update(const Vec3& probe, const UpdateBudget&, LinkUpdate& link) noexcept {
  if (!caught_) proxy_ = probe;
  caught_ = true;
  proxy_ += drag_jointly(probe - proxy_, Vec3{tau_});
  link.proxy = proxy_;
  link.state = HoldState::kHeld;
}

}  // namespace palpate
