/// Edges, face normals and volume of one tetrahedron, from which everything else about it follows.
///
/// With edges e_i = x_i - x_0 the inward double-area vectors of the faces opposite vertices 1, 2, 3 are
///   n_1 = e_2 x e_3,  n_2 = e_3 x e_1,  n_3 = e_1 x e_2,   and n_0 = -(n_1 + n_2 + n_3);
/// six volumes are V = e_1 . n_1, the barycentric coordinates of x are b_i = (x - x_0) . n_i / V for i > 0
/// and b_0 = 1 - b_1 - b_2 - b_3, and the height over face i is V / |n_i|.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "common/math/vec.h"

namespace palpate {

struct TetShape {
  Vec3 e1, e2, e3;
  Vec3 n1, n2, n3;
  double volume6;  ///< V, negative where the vertices turn the other way

  TetShape(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3) noexcept
      : e1(x1 - x0),
        e2(x2 - x0),
        e3(x3 - x0),
        n1(glm::cross(e2, e3)),
        n2(glm::cross(e3, e1)),
        n3(glm::cross(e1, e2)),
        volume6(glm::dot(e1, n1)) {}
  TetShape(const Vec3* points, const std::array<std::uint32_t, 4>& v) noexcept
      : TetShape(points[v[0]], points[v[1]], points[v[2]], points[v[3]]) {}

  /// Barycentric coordinates of x_0 + d. @pre not flat().
  [[nodiscard]] Vec4 barycentric(const Vec3& d) const noexcept {
    const double inverse = 1.0 / volume6;
    const double b1 = glm::dot(d, n1) * inverse;
    const double b2 = glm::dot(d, n2) * inverse;
    const double b3 = glm::dot(d, n3) * inverse;
    return {1.0 - b1 - b2 - b3, b1, b2, b3};
  }

  /// |n_i|^2.
  [[nodiscard]] double area2(int i) const noexcept {
    const Vec3 n = i == 0 ? n1 + n2 + n3 : i == 1 ? n1 : i == 2 ? n2 : n3;
    return glm::dot(n, n);
  }

  [[nodiscard]] double longest_edge2() const noexcept {
    const auto square = [](const Vec3& e) { return glm::dot(e, e); };
    return std::max({square(e1), square(e2), square(e3), square(e2 - e1), square(e3 - e1), square(e3 - e2)});
  }

  /// Least height at most kFlat of the longest edge: barycentric coordinates are then rounding alone.
  static constexpr double kFlat = 0x1p-40;
  [[nodiscard]] bool flat() const noexcept {
    const double largest = std::max(std::max(area2(0), area2(1)), std::max(area2(2), area2(3)));
    // Written so that 0 <= 0 counts.
    return volume6 * volume6 <= kFlat * kFlat * longest_edge2() * largest;
  }
};

}  // namespace palpate
