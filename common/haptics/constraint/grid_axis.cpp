#include "common/haptics/constraint/grid_axis.h"

#include <cmath>

#include "common/haptics/motion_rule.h"

namespace palpate {
namespace {

int largest_axis(const Vec3& x) noexcept {
  const Vec3 size = glm::abs(x);
  if (size.x >= size.y && size.x >= size.z) return 0;
  return size.y >= size.z ? 1 : 2;
}

}  // namespace

/// The node next to `u` on an axis.
double GridAxis::node(int axis, double u) const noexcept {
  return spacing_[axis] * std::round(u / spacing_[axis]);
}

/// At the nearest node, led by the line through it that comes nearest.
void GridAxis::catch_at(const Vec3& u) noexcept {
  for (int a = 0; a < 3; ++a) at_[a] = node(a, u[a]);
  leading_ = largest_axis(u - at_);
  caught_ = true;
}

/// Whether the probe at `u` pulls another axis over; then that one leads.
bool GridAxis::change_over(const Vec3& u) noexcept {
  Vec3 across = u - at_;
  across[leading_] = 0.0;
  const int pulled = largest_axis(across);
  const double crossing = node(leading_, u[leading_]);
  const bool at_crossing = std::abs(u[leading_] - crossing) <= settings_.threshold;
  if (!at_crossing || !(std::abs(across[pulled]) > settings_.threshold)) return false;
  at_[leading_] = crossing;
  leading_ = pulled;
  return true;
}

void GridAxis::update(const Vec3& probe, const UpdateBudget& /*budget*/, LinkUpdate& link) noexcept {
  const Vec3 u = (probe - origin_) * axes_;  // row vector times axes: the coordinates along them
  if (!caught_) {
    catch_at(u);
    link.jumped = true;
  } else {
    // An axis that is left is within the threshold, so that it cannot pull back: twice is enough.
    for (int n = 0; n < 2 && change_over(u); ++n) link.jumped = true;
  }
  const int a = leading_;
  const bool teeth = settings_.teeth > 0.0;
  at_[a] = teeth ? node(a, at_[a] + snap_drag(u[a] - at_[a], spacing_[a])) : u[a];
  link.proxy = origin_ + axes_ * at_;
  link.frame = axes_;
  if (teeth) link.kappa[a] = settings_.teeth;
  link.jacobian = teeth ? Mat3{0.0} : glm::outerProduct(axes_[a], axes_[a]);
  link.state = HoldState::kHeld;
}

}  // namespace palpate
