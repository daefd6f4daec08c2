#include "common/render/lens/shape_wire.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace palpate {
namespace {

using Polygon = std::vector<Vec3>;

/// What of a polygon lies where outward . x <= offset.
Polygon clipped(const Polygon& polygon, const Vec3& outward, double offset) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double at_a = glm::dot(outward, a) - offset, at_b = glm::dot(outward, b) - offset;
    if (at_a <= 0.0) kept.push_back(a);
    if ((at_a < 0.0 && at_b > 0.0) || (at_a > 0.0 && at_b < 0.0))
      kept.push_back(glm::mix(a, b, at_a / (at_a - at_b)));
  }
  return kept;
}

/// The part of a plane that lies within `bounds`.
Polygon section(const ConvexShape::HalfSpace& plane, const Box& bounds) {
  const double square = glm::dot(plane.outward, plane.outward);
  if (!(square > 0.0)) return {};
  const Vec3 normal = plane.outward / std::sqrt(square);
  const Vec3 small = glm::abs(normal);
  Vec3 axis{0.0};
  axis[small.x <= small.y && small.x <= small.z ? 0 : small.y <= small.z ? 1 : 2] = 1.0;
  const double reach = 2.0 * bounds.diagonal();
  const Vec3 u = reach * glm::normalize(glm::cross(normal, axis)), v = glm::cross(normal, u);
  const Vec3 middle =
      bounds.center() + (plane.offset - glm::dot(plane.outward, bounds.center())) / square * plane.outward;
  Polygon polygon{middle - u - v, middle + u - v, middle + u + v, middle - u + v};
  for (int a = 0; a < 3; ++a) {
    Vec3 outward{0.0};
    outward[a] = 1.0;
    polygon = clipped(clipped(polygon, outward, bounds.upper[a]), -outward, -bounds.lower[a]);
  }
  return polygon;
}

}  // namespace

std::vector<std::vector<Vec3>> shape_wire(const ConvexShape& shape, const Box& bounds) {
  std::vector<Polygon> lines;
  const auto add = [&lines](Polygon line) {
    if (line.size() < 3) return;
    line.push_back(line.front());
    lines.push_back(std::move(line));
  };
  if (shape.quadric && shape.half_spaces.empty()) {
    constexpr int kCorners = 48;
    const Mat3 data_from_unit = glm::inverse(shape.quadric->unit_from_data);
    for (int axis = 0; axis < 3; ++axis) {
      Polygon circle;
      for (int i = 0; i < kCorners; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kCorners;
        Vec3 unit{0.0};
        unit[(axis + 1) % 3] = std::cos(angle);
        unit[(axis + 2) % 3] = std::sin(angle);
        circle.push_back(shape.quadric->center + data_from_unit * unit);
      }
      add(std::move(circle));
    }
  }
  for (std::size_t face = 0; face < shape.half_spaces.size(); ++face) {
    Polygon polygon = section(shape.half_spaces[face], bounds);
    for (std::size_t other = 0; other < shape.half_spaces.size(); ++other) {
      if (other != face)
        polygon = clipped(polygon, shape.half_spaces[other].outward, shape.half_spaces[other].offset);
    }
    add(std::move(polygon));
  }
  return lines;
}

}  // namespace palpate
