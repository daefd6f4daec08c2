/// Vector and matrix types: GLM in double precision for data and geometry, in float for the GPU.
///
/// GLM's constructors leave members uninitialised: write `Vec3 x{0.0}` or give members initialisers.
/// Matrices are column major: m[c][r].
#pragma once

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "common/math/power_of_two.h"

namespace palpate {

using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;
using Vec4 = glm::dvec4;
using Mat3 = glm::dmat3;
using Mat4 = glm::dmat4;
using Vec3f = glm::vec3;
using Index3 = glm::ivec3;

[[nodiscard]] inline bool is_finite(const Vec3& x) noexcept {
  return std::isfinite(x.x) && std::isfinite(x.y) && std::isfinite(x.z);
}

/// v / |v|; zero where it has no direction: no length, or a component that is no finite number.
[[nodiscard]] inline Vec3 unit_or_zero(const Vec3& v) noexcept {
  const double length = glm::length(v);
  return length > 0.0 && std::isfinite(length) ? v / length : Vec3{0.0};
}

/// Between two directions, in [0, pi]; 0 where one has no length.
[[nodiscard]] inline double angle_between(const Vec3& a, const Vec3& b) noexcept {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}
/// Between two axes, which point both ways, in [0, pi / 2].
[[nodiscard]] inline double axis_angle(const Vec3& a, const Vec3& b) noexcept {
  return std::atan2(glm::length(glm::cross(a, b)), std::abs(glm::dot(a, b)));
}

/// Axis-aligned box; empty while lower > upper.
struct Box {
  Vec3 lower{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  Vec3 upper{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  void include(const Vec3& x) noexcept {
    lower = glm::min(lower, x);
    upper = glm::max(upper, x);
  }
  [[nodiscard]] bool empty() const noexcept { return !(lower.x <= upper.x); }
  /// Whether `x` lies in the closed box.
  [[nodiscard]] bool contains(const Vec3& x) const noexcept {
    return x.x >= lower.x && x.x <= upper.x && x.y >= lower.y && x.y <= upper.y && x.z >= lower.z &&
           x.z <= upper.z;
  }
  [[nodiscard]] Vec3 size() const noexcept { return empty() ? Vec3{0.0} : upper - lower; }
  [[nodiscard]] Vec3 center() const noexcept { return 0.5 * lower + 0.5 * upper; }
  /// Length of the diagonal; neither overflows nor underflows where the box itself does not.
  [[nodiscard]] double diagonal() const noexcept {
    const Vec3 extent = size();
    const double largest = glm::max(extent.x, glm::max(extent.y, extent.z));
    const double unit = power_of_two(binary_exponent(largest));
    return glm::length(extent / unit) * unit;
  }
};

/// |n|; 1 where that differs from it by rounding alone, so that a plane that was made unit once stays as it
/// is to the bit, however often it is written and read. @pre n is finite.
[[nodiscard]] inline double normal_length(const Vec3& n) noexcept {
  constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
  const double length = glm::length(n);
  return std::abs(length - 1.0) <= kRounding ? 1.0 : length;
}

}  // namespace palpate
