/// Scalars at the points of a grid, and the interpolant of one cell: what a servo step, a ray or a
/// contour evaluates once it has found its cell.
///
/// Inside the box cell with corners lo, lo + d the interpolant is, with u = (y - lo) / d in [0, 1]^3
/// and y along the grid's axes (box_grid.h),
///
///   s(u) = c_0 + c_x u_x + c_y u_y + c_z u_z + c_xy u_x u_y + c_yz u_y u_z + c_zx u_z u_x
///          + c_xyz u_x u_y u_z                                                                  (1)
///
/// which is linear along each axis, so that its Hessian has no diagonal. On a tetrahedron it is linear.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <variant>

#include "common/field/grid/box_grid.h"
#include "common/field/grid/sparse/sparse_numbers.h"
#include "common/field/grid/tet_mesh.h"
#include "common/math/jet.h"
#include "common/math/vec.h"

namespace palpate {

/// Sparse numbers where others are a span.
struct SparseSpan {
  const SparseNumbers* numbers = nullptr;

  [[nodiscard]] std::size_t size() const noexcept { return numbers->size(); }
  [[nodiscard]] float operator[](std::size_t index) const noexcept { return (*numbers)[index]; }
};

/// Scalars at the points of a grid, in the order of its points, as stored; multiplied by `scale` they are
/// local ones.
struct PointScalars {
  std::variant<std::span<const float>, std::span<const double>, std::span<const std::uint8_t>,
               std::span<const std::int16_t>, std::span<const std::uint16_t>, SparseSpan>
      values;
  double scale = 1.0;                 ///< a power of two
  std::shared_ptr<const void> owner;  ///< keeps `values` alive
};

/// The polynomial (1) of one cell, local values.
struct ScalarBoxCell {
  Vec3 lower{0.0};  ///< lo, along the axes; the bits of the grid lines
  Vec3 upper{1.0};
  Vec3 inverse_size{1.0};     ///< 1 / d
  std::array<double, 8> c{};  ///< c_0 c_x c_y c_z c_xy c_yz c_zx c_xyz
  Index3 index{0};
  bool bad_data = false;  ///< a corner's value is not finite or blanked

  [[nodiscard]] double value(const Vec3& y) const noexcept {
    const Vec3 u = (y - lower) * inverse_size;
    return (c[0] + u.x * c[1]) + u.y * (c[2] + u.x * c[4]) +
           u.z * ((c[3] + u.x * c[6]) + u.y * (c[5] + u.x * c[7]));
  }
  [[nodiscard]] Vec3 gradient(const Vec3& y) const noexcept {
    const Vec3 u = (y - lower) * inverse_size;
    return Vec3{(c[1] + u.y * c[4]) + u.z * (c[6] + u.y * c[7]),
                (c[2] + u.x * c[4]) + u.z * (c[5] + u.x * c[7]),
                (c[3] + u.y * c[5]) + u.x * (c[6] + u.y * c[7])} *
           inverse_size;
  }
  [[nodiscard]] Mat3 hessian(const Vec3& y) const noexcept {
    const Vec3 u = (y - lower) * inverse_size;
    const double xy = (c[4] + u.z * c[7]) * (inverse_size.x * inverse_size.y);
    const double yz = (c[5] + u.x * c[7]) * (inverse_size.y * inverse_size.z);
    const double zx = (c[6] + u.y * c[7]) * (inverse_size.z * inverse_size.x);
    return {Vec3{0.0, xy, zx}, Vec3{xy, 0.0, yz}, Vec3{zx, yz, 0.0}};
  }
};

/// The polynomial of `cell`. @pre `cell` lies in the grid, whose points the values belong to. @rt Safe.
void load_scalar_cell(const BoxGrid& grid, const PointScalars& values, const Index3& cell,
                      ScalarBoxCell& out) noexcept;

/// Local values at the vertices of a tetrahedron.
struct ScalarTet {
  Vec4 s{0.0};
  bool bad_data = false;  ///< a vertex's value is not finite
};
/// @pre The values belong to the points of the mesh that `tet` is of. @rt Safe.
[[nodiscard]] ScalarTet load_scalar_tet(const PointScalars& values, const TetMesh::Tet& tet) noexcept;

}  // namespace palpate
