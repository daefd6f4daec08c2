#include "common/render/lens/lens.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "common/base/check.h"
#include "common/math/vec.h"

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

constexpr double kInfinity = std::numeric_limits<double>::infinity();

ConvexShape::HalfSpace half_space(const Vec3& point, const Vec3& outward) {
  const Vec3 n = glm::normalize(outward);
  return {n, glm::dot(n, point)};
}

// A half-space that nothing lies in: shapes without size hold no line.
ConvexShape nothing() {
  ConvexShape shape;
  shape.half_spaces.push_back({Vec3(0.0, 0.0, 1.0), -kInfinity});
  return shape;
}

// Whether faces stand in opposite pairs at right angles, as those of make_box() and make_cylinder() do.
bool is_upright(const std::vector<ConvexShape::HalfSpace>& faces) {
  constexpr double kRounding = 1e-9;
  if (faces.size() % 2 != 0 || faces.size() > 6) return false;
  for (std::size_t i = 0; i < faces.size(); i += 2) {
    if (faces[i].outward != -faces[i + 1].outward) return false;
    for (std::size_t k = 0; k < i; k += 2) {
      if (std::abs(glm::dot(faces[i].outward, faces[k].outward)) > kRounding) return false;
    }
  }
  return true;
}

// The mean of all corners; nothing where there is none.
std::optional<Vec3> mean_of_corners(const std::vector<ConvexShape::HalfSpace>& faces) {
  constexpr double kRounding = 1e-9;
  double reach = 0.0;
  for (const ConvexShape::HalfSpace& h : faces) reach = std::max(reach, std::abs(h.offset));
  Vec3 sum{0.0};
  int count = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (std::size_t k = 0; k < j; ++k) {
        const Vec3 &a = faces[i].outward, &b = faces[j].outward, &c = faces[k].outward;
        const double volume = glm::dot(a, glm::cross(b, c));
        if (!(std::abs(volume) > kRounding)) continue;
        const Vec3 corner = (faces[i].offset * glm::cross(b, c) + faces[j].offset * glm::cross(c, a) +
                             faces[k].offset * glm::cross(a, b)) /
                            volume;
        const bool inside = std::all_of(faces.begin(), faces.end(), [&](const ConvexShape::HalfSpace& h) {
          return glm::dot(h.outward, corner) <= h.offset + kRounding * (reach + glm::length(corner));
        });
        if (!inside) continue;
        sum += corner;
        ++count;
      }
    }
  }
  if (count == 0) return std::nullopt;
  return sum / static_cast<double>(count);
}

// Whether a line in the direction `way` leaves all half-spaces in the end.
bool blocks(const std::vector<ConvexShape::HalfSpace>& faces, const Vec3& way) {
  constexpr double kRounding = 1e-9;
  return std::any_of(faces.begin(), faces.end(), [&](const ConvexShape::HalfSpace& h) {
    return glm::dot(h.outward, way) > kRounding * glm::length(way);
  });
}

// A polyhedron that has corners and goes on for ever does so along one of its edges; a cylinder along its
// axis.
bool is_bounded(const ConvexShape& shape) {
  constexpr double kRounding = 1e-9;
  const auto& faces = shape.half_spaces;
  if (shape.quadric) {
    const Mat3 rows = glm::transpose(shape.quadric->unit_from_data);
    Vec3 axis{0.0};
    for (int i = 0; i < 3; ++i) {
      const Vec3 across = glm::cross(rows[i], rows[(i + 1) % 3]);
      if (glm::length(across) > glm::length(axis)) axis = across;
    }
    const double size = std::sqrt(glm::length(axis));
    if (std::abs(glm::determinant(rows)) > kRounding * size * size * size) return true;
    return blocks(faces, axis) && blocks(faces, -axis);
  }
  if (!mean_of_corners(faces)) return false;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const Vec3 edge = glm::cross(faces[i].outward, faces[k].outward);
      if (!(glm::length(edge) > kRounding)) continue;
      if (!blocks(faces, edge) || !blocks(faces, -edge)) return false;
    }
  }
  return true;
}

// Whether there is room between the middle and each face.
bool has_middle(const ConvexShape& shape) {
  const Vec3 center = center_of(shape, Vec3(0.0));
  return std::all_of(shape.half_spaces.begin(), shape.half_spaces.end(),
                     [&](const ConvexShape::HalfSpace& h) { return glm::dot(h.outward, center) < h.offset; });
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

bool ConvexShape::contains(const Vec3& x) const noexcept {
  if (quadric) {
    const Vec3 u = quadric->unit_from_data * (x - quadric->center);
    if (!(glm::dot(u, u) <= 1.0)) return false;
  }
  return std::all_of(half_spaces.begin(), half_spaces.end(),
                     [&](const HalfSpace& h) { return glm::dot(h.outward, x) <= h.offset; });
}

LineInterval clip_line(const ConvexShape& shape, const Vec3& origin, const Vec3& direction) noexcept {
  LineInterval inside{-kInfinity, kInfinity};
  constexpr LineInterval kNone{0.0, 0.0};
  if (shape.quadric) {
    // |p + t v|^2 = 1
    const Vec3 p = shape.quadric->unit_from_data * (origin - shape.quadric->center);
    const Vec3 v = shape.quadric->unit_from_data * direction;
    const double a = glm::dot(v, v), b = glm::dot(p, v), c = glm::dot(p, p) - 1.0;
    if (a > 0.0) {
      const double discriminant = b * b - a * c;
      if (!(discriminant > 0.0)) return kNone;
      const double root = std::sqrt(discriminant);
      inside = {(-b - root) / a, (-b + root) / a};
    } else if (!(c <= 0.0)) {
      return kNone;
    }
  }
  for (const ConvexShape::HalfSpace& h : shape.half_spaces) {
    const double speed = glm::dot(h.outward, direction);
    const double room = h.offset - glm::dot(h.outward, origin);
    if (speed > 0.0) {
      inside.last = std::min(inside.last, room / speed);
    } else if (speed < 0.0) {
      inside.first = std::max(inside.first, room / speed);
    } else if (!(room >= 0.0)) {
      return kNone;
    }
  }
  return inside.first < inside.last ? inside : kNone;
}

ConvexShape make_sphere(const Vec3& center, double radius) {
  PALPATE_CHECK(is_finite(center) && std::isfinite(radius) && radius >= 0.0);
  if (radius == 0.0) return nothing();
  ConvexShape shape;
  shape.quadric = ConvexShape::Quadric{Mat3(1.0 / radius), center};
  return shape;
}

ConvexShape make_box(const Vec3& center, const Mat3& axes) {
  ConvexShape shape;
  for (int c = 0; c < 3; ++c) {
    if (axes[c] == Vec3(0.0)) return nothing();
    shape.half_spaces.push_back(half_space(center + axes[c], axes[c]));
    shape.half_spaces.push_back(half_space(center - axes[c], -axes[c]));
  }
  return shape;
}

ConvexShape make_cylinder(const Vec3& from, const Vec3& to, double radius) {
  PALPATE_CHECK(std::isfinite(radius) && radius >= 0.0);
  if (radius == 0.0 || from == to) return nothing();
  ConvexShape shape;
  const Vec3 axis = glm::normalize(to - from);
  // I - axis axis^T takes the part across the axis.
  const Mat3 across = Mat3(1.0) - glm::outerProduct(axis, axis);
  shape.quadric = ConvexShape::Quadric{across / radius, from};
  shape.half_spaces = {half_space(to, axis), half_space(from, -axis)};
  return shape;
}

ConvexShape make_polyhedron(std::span<const ConvexShape::HalfSpace> faces) {
  PALPATE_CHECK(faces.size() <= kMostHalfSpaces);
  ConvexShape shape;
  for (const ConvexShape::HalfSpace& face : faces) {
    const double length = normal_length(face.outward);
    shape.half_spaces.push_back({face.outward / length, face.offset / length});
  }
  return shape;
}

Vec3 center_of(const ConvexShape& shape, const Vec3& near) noexcept {
  Vec3 center = shape.quadric ? shape.quadric->center : near;
  const auto& faces = shape.half_spaces;
  const auto room = [&](const ConvexShape::HalfSpace& h) { return h.offset - glm::dot(h.outward, center); };
  if (faces.size() == 1) return center + room(faces[0]) * faces[0].outward;
  if (!is_upright(faces)) return shape.quadric ? center : mean_of_corners(faces).value_or(near);
  // Halfway between the faces of each pair.
  for (std::size_t i = 0; i + 1 < faces.size(); i += 2) {
    center += 0.5 * (room(faces[i]) - room(faces[i + 1])) * faces[i].outward;
  }
  return center;
}

ConvexShape moved(ConvexShape shape, const Vec3& shift) noexcept {
  if (shape.quadric) shape.quadric->center += shift;
  for (ConvexShape::HalfSpace& h : shape.half_spaces) h.offset += glm::dot(h.outward, shift);
  return shape;
}

ConvexShape scaled(ConvexShape shape, double factor) noexcept {
  const Vec3 center = center_of(shape, Vec3(0.0));
  if (shape.quadric) {
    shape.quadric->unit_from_data /= factor;
    shape.quadric->center = center + factor * (shape.quadric->center - center);
  }
  for (ConvexShape::HalfSpace& h : shape.half_spaces) {
    const double at_center = glm::dot(h.outward, center);
    h.offset = at_center + factor * (h.offset - at_center);
  }
  return shape;
}

bool ScreenCircle::holds(double at_x, double at_y) const noexcept {
  return std::hypot(at_x - x, at_y - y) <= radius;
}

bool magnifies(const Lens& lens) {
  if (lens.cut || lens.screen || !(lens.magnification > 1.0)) return false;
  return is_bounded(lens.shape) && has_middle(lens.shape);
}

bool has_transition(const Lens& lens) {
  if (lens.cut || lens.field > 0 || magnifies(lens) || !(lens.transition > 0.0)) return false;
  const bool everything = !lens.shape.quadric && lens.shape.half_spaces.empty();
  return everything ? lens.screen.has_value() : is_bounded(lens.shape) && has_middle(lens.shape);
}

}  // namespace palpate
