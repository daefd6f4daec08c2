#include "common/haptics/constraint/isotropic_drag.h"

#include "common/haptics/motion_rule.h"

namespace palpate {
namespace {

/// dp/dx of a probe that is `away` from the last proxy.
Mat3 drag_jacobian(const Vec3& away, double tau) noexcept {
  const double distance = glm::length(away);
  if (!(tau > 0.0)) return Mat3{1.0};
  if (!(distance > tau)) return Mat3{0.0};
  const Vec3 u = away / distance;
  return Mat3{1.0} - (tau / distance) * (Mat3{1.0} - glm::outerProduct(u, u));
}

}  // namespace

void IsotropicDrag::update(const Vec3& probe, const UpdateBudget&, LinkUpdate& link) noexcept {
  if (!caught_) proxy_ = probe;
  caught_ = true;
  const Vec3 away = probe - proxy_;
  link.jacobian = drag_jacobian(away, tau_);
  proxy_ += drag_jointly(away, Vec3{tau_});
  link.proxy = proxy_;
  link.state = HoldState::kHeld;
}

}  // namespace palpate
