#include "common/haptics/constraint/circle.h"

#include <algorithm>

#include "common/haptics/fade.h"
#include "common/haptics/frame_along.h"

namespace palpate {
namespace {

constexpr double kCore = 0.25;          // part of the radius within which the stiffness along u fades
constexpr double kLeastPart = 0x1p-20;  // of the radius: J stays finite on the axis

}  // namespace

CircleConstraint::CircleConstraint(const Vec3& center, const Vec3& normal, double radius)
    : center_(center), normal_(glm::normalize(normal)), radius_(radius), outward_(frame_along(normal_)[1]) {}

bool CircleConstraint::catch_foot(const Vec3& probe, int iterations, Foot& foot) noexcept {
  follow_foot(probe, iterations, foot);
  return true;
}

void CircleConstraint::follow_foot(const Vec3& probe, int /*iterations*/, Foot& foot) noexcept {
  const Vec3 away = probe - center_;
  const Vec3 flat = away - glm::dot(away, normal_) * normal_;
  const double distance = glm::length(flat);
  if (distance > kLeastPart * radius_) outward_ = flat / distance;
  const Vec3 along = glm::cross(normal_, outward_);
  foot.point = center_ + radius_ * outward_;
  foot.axes = {along, outward_, normal_};
  foot.kappa.y = fade(distance / (kCore * radius_));
  foot.jacobian = (radius_ / std::max(distance, kLeastPart * radius_)) * glm::outerProduct(along, along);
}

}  // namespace palpate
