#include "common/haptics/constraint/shape.h"

namespace palpate {

void ShapeConstraint::reset() noexcept {
  held_ = false;
  forget();
}

void ShapeConstraint::update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept {
  Foot foot;
  link.proxy = probe;
  if (held_) {
    follow_foot(probe, budget.iterations, foot);
  } else if (!catch_foot(probe, budget.iterations, foot)) {
    link.iterations = foot.iterations;
    return;
  }
  link.iterations = foot.iterations;
  const double stretch = glm::distance(probe, foot.point);
  const bool holds = stretch <= (held_ ? settings_.release_distance : settings_.snap_distance);
  link.jumped = holds != held_;
  if (!holds) {
    if (held_) link.state = HoldState::kReleased;
    reset();
    return;
  }
  held_ = true;
  link.proxy = foot.point;
  link.frame = foot.axes;
  link.kappa = foot.kappa;
  link.jacobian = foot.jacobian;
  link.state = foot.certain ? HoldState::kHeld : HoldState::kFellBack;
}

}  // namespace palpate
