#include "common/render/lens/plane_section.h"

#include <cmath>
#include <cstddef>

namespace palpate {
namespace {

/// What of a convex polygon lies in a half-space (Sutherland and Hodgman 1974).
std::vector<Vec3> kept_part(const std::vector<Vec3>& polygon, const ConvexShape::HalfSpace& half_space) {
  std::vector<Vec3> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double room_a = half_space.offset - glm::dot(half_space.outward, a);
    const double room_b = half_space.offset - glm::dot(half_space.outward, b);
    if (room_a >= 0.0) kept.push_back(a);
    if ((room_a > 0.0 && room_b < 0.0) || (room_a < 0.0 && room_b > 0.0))
      kept.push_back(glm::mix(a, b, room_a / (room_a - room_b)));
  }
  return kept;
}

}  // namespace

std::vector<Vec3> plane_section(const ConvexShape::HalfSpace& plane,
                                std::span<const ConvexShape::HalfSpace> within, const Vec3& near,
                                double reach) {
  const Vec3& n = plane.outward;
  const double away = plane.offset - glm::dot(n, near);
  if (!(std::abs(away) <= reach)) return {};
  // A square that holds all of the section, then what each half-space leaves of it.
  const Vec3 middle = near + away * n;
  const Vec3 side = std::abs(n.z) < 0.5 ? Vec3(0.0, 0.0, 1.0) : Vec3(1.0, 0.0, 0.0);
  const Vec3 u = 2.0 * reach * glm::normalize(glm::cross(side, n)), v = glm::cross(n, u);
  std::vector<Vec3> polygon{middle - u - v, middle + u - v, middle + u + v, middle - u + v};
  for (const ConvexShape::HalfSpace& half_space : within) polygon = kept_part(polygon, half_space);
  return polygon.size() < 3 ? std::vector<Vec3>() : polygon;
}

std::vector<Vec3> plane_section(const ConvexShape::HalfSpace& plane, const Box& box) {
  const Vec3 half = 0.5 * box.size();
  const ConvexShape shape =
      make_box(box.center(), Mat3(Vec3(half.x, 0.0, 0.0), Vec3(0.0, half.y, 0.0), Vec3(0.0, 0.0, half.z)));
  return plane_section(plane, shape.half_spaces, box.center(), box.diagonal());
}

}  // namespace palpate
