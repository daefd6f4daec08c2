#include "common/haptics/constraint/sphere.h"

#include <algorithm>

#include "common/haptics/fade.h"
#include "common/haptics/frame_along.h"

namespace palpate {
namespace {

constexpr double kCore = 0.25;          // part of the radius within which kappa fades
constexpr double kLeastPart = 0x1p-20;  // of the radius: J stays finite at the centre

}  // namespace

bool SphereConstraint::catch_foot(const Vec3& probe, int iterations, Foot& foot) noexcept {
  follow_foot(probe, iterations, foot);
  return true;
}

void SphereConstraint::follow_foot(const Vec3& probe, int /*iterations*/, Foot& foot) noexcept {
  const Vec3 away = probe - center_;
  const double distance = glm::length(away);
  if (distance > kLeastPart * radius_) normal_ = away / distance;
  foot.point = center_ + radius_ * normal_;
  foot.axes = frame_along(normal_);
  foot.kappa = Vec3{fade(distance / (kCore * radius_))};
  const double pace = radius_ / std::max(distance, kLeastPart * radius_);
  foot.jacobian = pace * (Mat3{1.0} - glm::outerProduct(normal_, normal_));
}

}  // namespace palpate
