#include "common/haptics/constraint/grid_axis.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/haptics/fade.h"
#include "common/haptics/motion_rule.h"

namespace palpate {
namespace {

/// A plane that an axis meets at less than some 6 degrees is no place along it.
constexpr double kGrazing = 0.1;

int largest_axis(const Vec3& x) noexcept {
  const Vec3 size = glm::abs(x);
  if (size.x >= size.y && size.x >= size.z) return 0;
  return size.y >= size.z ? 1 : 2;
}

}  // namespace

GridAxis::GridAxis(const Vec3& origin, const Mat3& axes, const Vec3& spacing,
                   std::span<const Landmark> landmarks)
    : origin_(origin), axes_(axes), spacing_(spacing) {
  PALPATE_CHECK(landmarks.size() <= kMaxLandmarks);
  for (const Landmark& landmark : landmarks) {
    landmarks_[as_size(landmark_count_++)] = {landmark.normal * axes_,
                                              landmark.offset - glm::dot(landmark.normal, origin_)};
  }
}

/// The node next to `u` on an axis.
double GridAxis::node(int axis, double u) const noexcept {
  return spacing_[axis] * std::round(u / spacing_[axis]);
}

GridAxis::Notch GridAxis::notch_near(double u) const noexcept {
  Notch nearest;
  double second = HUGE_VAL;  // distance of the nearest landmark to the one after it
  const auto crossing = [this](const Landmark& mark, double& at) {
    const double along = mark.normal[leading_];
    if (std::abs(along) < kGrazing) return false;
    Vec3 across = at_;
    across[leading_] = 0.0;
    at = (mark.offset - glm::dot(mark.normal, across)) / along;
    return true;
  };
  double at = 0.0;
  for (int i = 0; i < landmark_count_; ++i) {
    if (!crossing(landmarks_[as_size(i)], at)) continue;
    if (nearest.there && std::abs(at - u) >= std::abs(nearest.at - u)) continue;
    nearest.there = true;
    nearest.at = at;
  }
  if (!nearest.there) return nearest;
  for (int i = 0; i < landmark_count_; ++i) {
    if (!crossing(landmarks_[as_size(i)], at) || at == nearest.at) continue;
    second = std::min(second, std::abs(at - nearest.at));
  }
  nearest.reach = std::min(settings_.notch, 0.5 * second);
  return nearest;
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
  if (!(std::abs(across[pulled]) > settings_.threshold)) return false;
  const auto within = [&](double place) { return std::abs(u[leading_] - place) <= settings_.threshold; };
  const Notch notch = notch_near(u[leading_]);
  const double next = node(leading_, u[leading_]);
  if (notch.there && within(notch.at)) {
    at_[leading_] = notch.at;
  } else if (settings_.switch_at == GridSwitch::kNodes && within(next)) {
    at_[leading_] = next;
  } else {
    return false;
  }
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
  const Notch notch = notch_near(u[a]);
  const bool detents = settings_.detents > 0.0;
  if (notch.there && std::abs(u[a] - notch.at) < notch.reach) {
    at_[a] = notch.at;
    link.kappa[a] = notch_hold(u[a] - notch.at, notch.reach);
    link.jacobian = Mat3{0.0};
  } else {
    at_[a] = detents ? node(a, at_[a] + snap_drag(u[a] - at_[a], spacing_[a])) : u[a];
    if (detents) link.kappa[a] = settings_.detents;
    link.jacobian = detents ? Mat3{0.0} : glm::outerProduct(axes_[a], axes_[a]);
  }
  link.proxy = origin_ + axes_ * at_;
  link.frame = axes_;
  link.state = HoldState::kHeld;
}

}  // namespace palpate
