/// Uniform and rectilinear grids: direct cell search and trilinear cells.
///
/// Coordinates y run along the grid's axes: x = B y in local frame L, where the columns of B are unit vectors
/// along the axes. B is the identity unless a uniform grid is sheared: its axes are at no right angles.
///
/// Inside the cell with corners lo, lo + d the interpolant is, with u = (y - lo) / d in [0, 1]^3,
///
///   v(u) = c_0 + c_x u_x + c_y u_y + c_z u_z + c_xy u_x u_y + c_yz u_y u_z + c_zx u_z u_x
///          + c_xyz u_x u_y u_z                                                                  (1)
///
/// which continues smoothly past the faces: a tracer integrates (1) and then cuts at the face.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/base/index.h"
#include "common/field/sample.h"
#include "common/math/vec.h"

namespace palpate {

struct PointVectors;

/// The polynomial (1) of one cell.
struct BoxCell {
  Vec3 lower{0.0};          ///< lo, along the axes
  Vec3 size{1.0};           ///< d
  Vec3 inverse_size{1.0};   ///< 1 / d
  std::array<Vec3, 8> c{};  ///< c_0 c_x c_y c_z c_xy c_yz c_zx c_xyz, local speed
  Index3 index{0};          ///< cell index
  bool bad_data = false;    ///< hidden, or a corner's value is not finite or blanked

  [[nodiscard]] Vec3 velocity(const Vec3& y) const noexcept {
    const Vec3 u = (y - lower) * inverse_size;
    // Horner in z, then y, then x.
    return (c[0] + u.x * c[1]) + u.y * (c[2] + u.x * c[4]) +
           u.z * ((c[3] + u.x * c[6]) + u.y * (c[5] + u.x * c[7]));
  }

  /// dv/dy, m[j] = dv/dy_j.
  [[nodiscard]] Mat3 jacobian(const Vec3& y) const noexcept {
    const Vec3 u = (y - lower) * inverse_size;
    return Mat3{(c[1] + u.y * c[4] + u.z * c[6] + u.y * u.z * c[7]) * inverse_size.x,
                (c[2] + u.x * c[4] + u.z * c[5] + u.x * u.z * c[7]) * inverse_size.y,
                (c[3] + u.y * c[5] + u.x * c[6] + u.x * u.y * c[7]) * inverse_size.z};
  }
};

class BoxGrid {
 public:
  /// Uniform: points at origin + spacing * (i, j, k). @pre points >= 2, spacing > 0 on each axis.
  BoxGrid(const Index3& points, const Vec3& origin, const Vec3& spacing);
  /// Uniform and sheared: `origin` and `spacing` along the axes. @pre `directions` is B, of positive determinant.
  BoxGrid(const Index3& points, const Vec3& origin, const Vec3& spacing, const Mat3& directions);
  /// Rectilinear: strictly increasing coordinates, at least two an axis.
  explicit BoxGrid(std::array<std::vector<double>, 3> coordinates);
  /// Makes cells bad data whatever their corners hold. @pre one byte a cell, 1 where hidden.
  void hide_cells(std::vector<std::uint8_t> hidden);
  [[nodiscard]] bool hidden(const Index3& cell) const noexcept {
    if (hidden_.empty()) return false;
    const auto row = as_size(points_.x - 1);
    const auto column = as_size(points_.y - 1);
    return hidden_[as_size(cell.x) + row * (as_size(cell.y) + column * as_size(cell.z))] != 0;
  }

  [[nodiscard]] const Index3& points() const noexcept { return points_; }
  [[nodiscard]] Box bounds() const noexcept;  ///< along the axes
  [[nodiscard]] bool uniform() const noexcept { return coordinates_[0].empty(); }

  /// @name Between frame L and the axes
  /// @{
  [[nodiscard]] bool sheared() const noexcept { return sheared_; }
  [[nodiscard]] const Mat3& directions() const noexcept { return directions_; }  ///< B
  /// B^-1 x; what it puts beyond the border by no more than rounding is on the border.
  [[nodiscard]] Vec3 along_axes(const Vec3& x) const noexcept { return sheared_ ? sheared_along_axes(x) : x; }
  [[nodiscard]] Vec3 in_frame(const Vec3& y) const noexcept { return sheared_ ? directions_ * y : y; }
  [[nodiscard]] Mat3 gradients() const noexcept {
    return glm::transpose(inverse_);
  }  ///< B^-T: of y_1, y_2, y_3
  /// B^-T times the gradient along the axes.
  [[nodiscard]] Vec3 gradient_in_frame(const Vec3& g) const noexcept { return sheared_ ? g * inverse_ : g; }
  [[nodiscard]] Mat3 hessian_in_frame(const Mat3& h) const noexcept {
    return sheared_ ? glm::transpose(inverse_) * h * inverse_ : h;
  }
  /// @}

  /// All that follow take and give coordinates along the axes.

  /// The cell that holds `y`; points on a shared face belong to the upper cell, on the upper border to the
  /// last one. False outside and for NaN.
  [[nodiscard]] bool locate(const Vec3& y, Index3& cell) const noexcept;
  /// Position of grid line `i` on `axis`. The same bits from either side of a face.
  [[nodiscard]] double coordinate(int axis, int i) const noexcept;
  /// Loads the polynomial of `cell`. @pre `cell` lies in the grid.
  void load(const Index3& cell, const PointVectors& values, BoxCell& out) const noexcept;

 private:
  [[nodiscard]] Vec3 sheared_along_axes(const Vec3& x) const noexcept;

  Index3 points_{0};
  Vec3 origin_{0.0};
  Vec3 spacing_{1.0};
  Vec3 inverse_spacing_{1.0};
  bool sheared_ = false;
  Mat3 directions_{1.0}, inverse_{1.0};  ///< B and B^-1
  std::array<std::vector<double>, 3> coordinates_;
  std::array<std::vector<double>, 3> inverse_widths_;  ///< rectilinear: 1 / width of each interval
  std::vector<std::uint8_t> hidden_;                   ///< cells; empty where none is
};

}  // namespace palpate
