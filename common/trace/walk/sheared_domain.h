/// A sheared uniform grid for walks (domain.h): places and velocities in frame L, cells along the grid's axes.
///
/// Along the axes, y = B^-1 x (box_grid.h), cells are boxes and faces are those of BoxDomain, and a path
/// x + s n + s^2 c / 2 is one of the same s, with B^-1 n and B^-1 c. Velocities stay those of frame L.
#pragma once

#include "common/field/grid/box_grid.h"
#include "common/trace/walk/domain.h"

namespace palpate {

class ShearedDomain {
 public:
  /// @pre field.box_grid().
  ShearedDomain(const VectorField& field, double sign) : box_(field, sign), grid_(field.box_grid()) {
    const Mat3 inverse = glm::transpose(grid_->gradients());
    for (int axis = 0; axis < 3; ++axis) {
      to_axes_[as_size(axis)] = Pack4{inverse[axis], 0.0};
      rows_[as_size(axis)] = grid_->gradients()[axis];
    }
  }

  [[nodiscard]] bool locate(const Vec3& x) { return box_.locate(grid_->along_axes(x)); }
  [[nodiscard]] std::int64_t cell() const { return box_.cell(); }
  void save(StateWriter& out) const { box_.save(out); }
  void restore(StateReader& in) { box_.restore(in); }
  [[nodiscard]] bool bad() const { return box_.bad(); }
  [[nodiscard]] double rest_speed() const { return box_.rest_speed(); }
  [[nodiscard]] double data_error() const { return box_.data_error(); }
  [[nodiscard]] double size() const { return box_.size(); }
  [[nodiscard]] double face_scale() const { return box_.face_scale(); }

  [[nodiscard]] Pack4 velocity(const Pack4& x) const { return box_.velocity(along(x)); }
  [[nodiscard]] FlowGradient gradient(const Pack4& x) const {
    const FlowGradient g = box_.gradient(along(x));
    const auto by = [&](int axis) {
      return (rows_[0][axis] * g.column[0] + rows_[1][axis] * g.column[1]) + rows_[2][axis] * g.column[2];
    };
    return {by(0), by(1), by(2)};
  }

  [[nodiscard]] static constexpr int face_count() { return BoxFaces::face_count(); }
  /// To rounding: a place that was put on a face is beside it by that.
  [[nodiscard]] bool inside(const Pack4& x, int reached) const {
    const Pack4 y = along(x);
    bool in = true;
    for (int face = 0; face < face_count(); ++face)
      in = in &&
           (face == reached || box_.face_value(face, y) >= -kShearRounding * box_.face_rounding(face, y));
    return in;
  }
  [[nodiscard]] double face_value(int face, const Pack4& x) const { return box_.face_value(face, along(x)); }
  [[nodiscard]] double face_rate(int face, const Pack4& d) const {
    return BoxFaces::face_rate(face, along(d));
  }
  [[nodiscard]] double face_rounding(int face, const Pack4& x) const {
    return kShearRounding * box_.face_rounding(face, along(x));
  }
  [[nodiscard]] Crossing predict(const Pack4& x, const Pack4& n, const Pack4& curvature, int entry,
                                 double reach) const {
    return box_.predict(along(x), along(n), along(curvature), entry, reach);
  }
  [[nodiscard]] bool cross(int face, Pack4& x, int& entry) {
    const Pack4 before = along(x);
    Pack4 y = before;
    const bool goes_on = box_.cross(face, y, entry);
    x = x + Pack4{grid_->in_frame((y - before).xyz()), 0.0};
    return goes_on;
  }

 private:
  static constexpr double kShearRounding = 4.0;  ///< of B^-1 x against that of x

  /// Of a place or a direction; nothing in the lane of time.
  [[nodiscard]] Pack4 along(const Pack4& v) const {
    return (v.lo[0] * to_axes_[0] + v.lo[1] * to_axes_[1]) + v.hi[0] * to_axes_[2];
  }

  BoxDomain box_;
  const BoxGrid* grid_;
  std::array<Pack4, 3> to_axes_;  ///< columns of B^-1
  std::array<Vec3, 3> rows_;      ///< its rows
};

}  // namespace palpate
