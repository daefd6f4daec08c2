#include "common/hand/technique/pick.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

/// Between two directions, in [0, pi]; 0 where one has no length.
double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

std::optional<std::size_t> pick_by_ray(const Ray& ray, std::span<const PickBall> balls) noexcept {
  std::optional<std::size_t> picked;
  double nearest = HUGE_VAL;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Vec3 to = balls[i].center - ray.origin;
    const double along = glm::dot(to, ray.direction), aside = glm::length(to - along * ray.direction);
    const double r = balls[i].radius;
    if (!(aside <= r) || along + r < 0.0) continue;
    // Where it goes in, or the origin where that lies within.
    const double enters = std::max(0.0, along - std::sqrt(r * r - aside * aside));
    if (!(enters < nearest)) continue;
    nearest = enters;
    picked = i;
  }
  return picked;
}

std::optional<std::size_t> pick_by_aperture(const Aperture& aperture,
                                            std::span<const PickBall> balls) noexcept {
  const Vec3 axis = aperture.center - aperture.eye;
  const double half = std::atan2(aperture.radius, glm::length(axis));
  std::optional<std::size_t> picked;
  double best = HUGE_VAL, best_distance = HUGE_VAL;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Vec3 to = balls[i].center - aperture.eye;
    const double distance = glm::length(to);
    const double off = angle_between(to, axis);
    // A ball around the eye is met by every cone.
    const double seen = distance > balls[i].radius ? std::asin(balls[i].radius / distance) : HUGE_VAL;
    if (!(off <= half + seen)) continue;
    if (off > best || (off == best && !(distance < best_distance))) continue;
    best = off;
    best_distance = distance;
    picked = i;
  }
  return picked;
}

}  // namespace palpate
