#include "common/device/driver/vrpn/local_field.h"

#include <algorithm>

#include "common/device/driver/arm_settings.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

Mat3 times(const Vec3& a, const Vec3& b) noexcept { return glm::outerProduct(a, b); }

/// `a` with its eigenvalues brought into [lowest, highest].
Mat3 with_values_within(const Mat3& a, double lowest, double highest) noexcept {
  const SymmetricEigen eigen = symmetric_eigen(a);
  Mat3 clamped{0.0};
  for (int i = 0; i < 3; ++i) {
    clamped += std::clamp(eigen.values[i], lowest, highest) * times(eigen.vectors[i], eigen.vectors[i]);
  }
  return clamped;
}

}  // namespace

void LocalField::add(const Vec3& x, const Vec3& force) noexcept {
  if (!is_finite(x) || !is_finite(force)) return reset();
  const Vec3 held = force_within(force, cap_);
  // Without a force there is nothing to learn from, and what was learned is of another place.
  if (!any_ || held == Vec3{0.0} || learned_force_ == Vec3{0.0}) {
    if (held == Vec3{0.0}) stiffness_ = Mat3{0.0};
    learned_x_ = x;
    learned_force_ = held;
  } else if (const Vec3 s = x - learned_x_; glm::length(s) >= kLeastMove) {
    const double ss = glm::dot(s, s);
    const Vec3 q = held - learned_force_ - stiffness_ * s;
    stiffness_ += (times(q, s) + times(s, q)) / ss - (glm::dot(s, q) / (ss * ss)) * times(s, s);
    stiffness_ = with_values_within(stiffness_, -stiffest_, 0.0);
    learned_x_ = x;
    learned_force_ = held;
  }
  any_ = true;
  x_ = x;
  force_ = held;
}

LocalField::Model LocalField::model() const noexcept {
  if (!any_ || force_ == Vec3{0.0}) return {.origin = x_};
  Model model{.origin = x_, .force = force_, .stiffness = stiffness_, .radius = radius_};
  const double stiffest = -symmetric_eigenvalues(stiffness_)[2];
  const double left = std::max(0.0, cap_ - glm::length(force_));
  if (stiffest * radius_ > left) model.stiffness *= left / (stiffest * radius_);
  return model;
}

void LocalField::reset() noexcept {
  any_ = false;
  force_ = learned_force_ = Vec3{0.0};
  stiffness_ = Mat3{0.0};
}

}  // namespace palpate
