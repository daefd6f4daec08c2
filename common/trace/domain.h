/// Where a line is followed by the general methods: the kernel of one cell and its faces. Frame L.
///
/// A domain holds one loaded cell, whose formula continues smoothly past the faces: velocity(), along() and
/// jacobian() may be asked anywhere near it. Positions are Pack4 with the time in the last lane, which the
/// kernels ignore; velocities have 0 there. Faces are affine functions of position, positive inside; where
/// a face's value counts as zero (`entry`), the cell was entered by it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/field/analytic/analytic_field.h"
#include "common/field/grid/box_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/vector_field.h"
#include "common/trace/exact_walk.h"
#include "common/trace/pack4.h"

namespace palpate {

/// Depth behind a face, relative to the numbers it is computed from, that is rounding.
inline constexpr double kGrazing = 4.0 * std::numeric_limits<double>::epsilon();

/// The first crossing that a parabola predicts.
struct Crossing {
  int face = -1;
  double distance = HUGE_VAL;
};

/// Smallest s > 0 with value + rate s + curvature s^2 / 2 = 0; infinite where there is none, and where the
/// parabola dips below zero by no more than `grazing`: a line that only touches a face would else be handed
/// to and fro between the cells beside it.
[[nodiscard]] inline double first_root(double value, double rate, double curvature, double grazing) {
  const double disc = rate * rate - 2.0 * curvature * value;
  if (disc < 0.0 || (curvature > 0.0 && disc <= 2.0 * curvature * grazing)) return HUGE_VAL;
  const double root = std::sqrt(disc);
  if (rate <= 0.0) {
    const double below = root - rate;
    return below > 0.0 ? 2.0 * value / below : HUGE_VAL;
  }
  return curvature < 0.0 ? (rate + root) / -curvature : HUGE_VAL;
}

/// Axis-aligned box faces: 2 a is the lower, 2 a + 1 the upper one of axis a.
class BoxFaces {
 public:
  [[nodiscard]] double face_value(int face, const Pack4& y) const {
    const int axis = face >> 1;
    return (face & 1) != 0 ? upper_[axis] - y[axis] : y[axis] - lower_[axis];
  }
  [[nodiscard]] static double face_rate(int face, const Pack4& d) {
    return (face & 1) != 0 ? -d[face >> 1] : d[face >> 1];
  }
  [[nodiscard]] static constexpr int face_count() { return 6; }
  /// Whether a point lies on the inner side of every face but `reached`, whose own side is not asked.
  [[nodiscard]] bool inside(const Pack4& y, int reached) const {
    bool in = true;
    for (int axis = 0; axis < 3; ++axis) {
      in = in && (y[axis] >= lower_[axis] || reached == 2 * axis);
      in = in && (y[axis] <= upper_[axis] || reached == 2 * axis + 1);
    }
    return in;
  }

 protected:
  Vec3 lower_{0.0}, upper_{0.0};
};

/// A uniform or rectilinear grid.
class BoxDomain : public BoxFaces {
 public:
  BoxDomain(const VectorField& field, double sign)
      : grid_(field.box_grid()), values_(&field.values()), sign_(sign) {}

  [[nodiscard]] bool locate(const Vec3& x) {
    if (!grid_->locate(x, index_)) return false;
    load();
    return true;
  }
  [[nodiscard]] bool bad() const { return bad_; }
  [[nodiscard]] double size() const { return size_; }

  [[nodiscard]] Pack4 velocity(const Pack4& y) const {
    const Pack4 u = inverse_size_ * (y - corner_);
    const double ux = u.lo[0], uy = u.lo[1], uz = u.hi[0];
    return ((c_[0] + ux * c_[1]) + uy * (c_[2] + ux * c_[4])) +
           uz * ((c_[3] + ux * c_[6]) + uy * (c_[5] + ux * c_[7]));
  }
  /// Jacobian times d.
  [[nodiscard]] Pack4 along(const Pack4& y, const Pack4& d) const {
    const Pack4 u = inverse_size_ * (y - corner_);
    const Pack4 du = inverse_size_ * d;
    const double ux = u.lo[0], uy = u.lo[1], uz = u.hi[0];
    return du.lo[0] * ((c_[1] + uy * c_[4]) + uz * (c_[6] + uy * c_[7])) +
           du.lo[1] * ((c_[2] + ux * c_[4]) + uz * (c_[5] + ux * c_[7])) +
           du.hi[0] * ((c_[3] + uy * c_[5]) + ux * (c_[6] + uy * c_[7]));
  }
  [[nodiscard]] Mat3 jacobian(const Pack4& y) const {
    return {along(y, {1.0, 0.0, 0.0, 0.0}).xyz(), along(y, {0.0, 1.0, 0.0, 0.0}).xyz(),
            along(y, {0.0, 0.0, 1.0, 0.0}).xyz()};
  }

  [[nodiscard]] Crossing predict(const Pack4& y, const Pack4& n, const Pack4& curvature, int entry) const {
    Crossing first;
    for (int axis = 0; axis < 3; ++axis) {
      const double rate = n[axis], bend = curvature[axis];
      // The face ahead; the one behind only where the curve may turn back to it.
      const bool up = rate > 0.0;
      consider(2 * axis + (up ? 1 : 0), y, rate, bend, entry, first);
      if (rate * bend < 0.0) consider(2 * axis + (up ? 0 : 1), y, rate, bend, entry, first);
    }
    return first;
  }

  /// Goes on behind `face`, onto which a point that reached it to rounding is put. False where the line
  /// leaves the grid by it.
  [[nodiscard]] bool cross(int face, Pack4& y, int& entry) {
    const int axis = face >> 1;
    const bool up = (face & 1) != 0;
    const double border = up ? upper_[axis] : lower_[axis];
    constexpr double kReached = 1e-9;  // of the cell
    const bool on_face = std::abs(y[axis] - border) <= kReached * size_;
    if (on_face) y.set(axis, border);
    const int next = index_[axis] + (up ? 1 : -1);
    if (next < 0 || next >= grid_->points()[axis] - 1) return false;
    index_[axis] = next;
    entry = !on_face ? -1 : up ? face - 1 : face + 1;
    load();
    return true;
  }

 private:
  void consider(int face, const Pack4& y, double rate, double bend, int entry, Crossing& first) const {
    const bool upper = (face & 1) != 0;
    const double value = face == entry ? 0.0 : face_value(face, y);
    const double grazing = kGrazing * (size_ + std::abs(y[face >> 1]));
    const double s = first_root(value, upper ? -rate : rate, upper ? -bend : bend, grazing);
    if (s < first.distance) first = {face, s};
  }

  void load() {
    BoxCell cell;
    grid_->load(index_, *values_, cell);
    bad_ = cell.bad_data;
    corner_ = Pack4{cell.lower, 0.0};
    inverse_size_ = Pack4{cell.inverse_size, 0.0};
    for (std::size_t k = 0; k < 8; ++k) c_[k] = Pack4{sign_ * cell.c[k], 0.0};
    for (int axis = 0; axis < 3; ++axis) {
      lower_[axis] = grid_->coordinate(axis, index_[axis]);
      upper_[axis] = grid_->coordinate(axis, index_[axis] + 1);
    }
    size_ = std::max(cell.size.x, std::max(cell.size.y, cell.size.z));
  }

  const BoxGrid* grid_;
  const PointVectors* values_;
  double sign_;
  Index3 index_{0};
  bool bad_ = false;
  double size_ = 1.0;
  Pack4 corner_, inverse_size_;
  std::array<Pack4, 8> c_;
};

/// A tetrahedral mesh with linear interpolation.
class TetDomain {
 public:
  TetDomain(const ExactMesh& mesh, double sign) : mesh_(&mesh), sign_(sign) {}

  [[nodiscard]] bool locate(const Vec3& x);
  [[nodiscard]] bool bad() const { return bad_; }
  [[nodiscard]] double size() const { return size_; }

  [[nodiscard]] Pack4 velocity(const Pack4& y) const {
    const Pack4 d = y - corner_;
    return origin_ + (d.lo[0] * column_[0] + d.lo[1] * column_[1]) + d.hi[0] * column_[2];
  }
  [[nodiscard]] Pack4 along(const Pack4&, const Pack4& d) const {
    return (d.lo[0] * column_[0] + d.lo[1] * column_[1]) + d.hi[0] * column_[2];
  }
  [[nodiscard]] Mat3 jacobian(const Pack4&) const {
    return {column_[0].xyz(), column_[1].xyz(), column_[2].xyz()};
  }

  [[nodiscard]] static constexpr int face_count() { return 4; }
  [[nodiscard]] bool inside(const Pack4& y, int reached) const {
    bool in = true;
    constexpr double kRounding = -1e-14;
    for (int face = 0; face < 4; ++face) in = in && (face == reached || face_value(face, y) >= kRounding);
    return in;
  }
  [[nodiscard]] double face_value(int face, const Pack4& y) const {
    const auto i = static_cast<std::size_t>(face);
    return face_offset_[i] + glm::dot(face_[i], (y - corner_).xyz());
  }
  [[nodiscard]] double face_rate(int face, const Pack4& d) const {
    return glm::dot(face_[static_cast<std::size_t>(face)], d.xyz());
  }
  [[nodiscard]] Crossing predict(const Pack4& y, const Pack4& n, const Pack4& curvature, int entry) const {
    Crossing first;
    for (int face = 0; face < 4; ++face) {
      const double value = face == entry ? 0.0 : face_value(face, y);
      const double s = first_root(value, face_rate(face, n), face_rate(face, curvature), kGrazing);
      if (s < first.distance) first = {face, s};
    }
    return first;
  }
  [[nodiscard]] bool cross(int face, Pack4& y, int& entry);

 private:
  void load(CellIndex cell);

  const ExactMesh* mesh_;
  double sign_;
  CellIndex cell_ = kNoCell;
  bool bad_ = false;
  double size_ = 1.0;
  Pack4 corner_, origin_;
  std::array<Pack4, 3> column_;          ///< of the velocity gradient
  std::array<Vec3, 4> face_{};           ///< gradients of the barycentric coordinates
  std::array<double, 4> face_offset_{};  ///< their values at the corner
};

/// A formula; the only faces are its bounds.
class FormulaDomain : public BoxFaces {
 public:
  FormulaDomain(const VectorField& field, double sign) : formula_(field.analytic()), sign_(sign) {
    const Box box = formula_->bounds();
    lower_ = box.lower;
    upper_ = box.upper;
    size_ = box.diagonal();
  }

  [[nodiscard]] bool locate(const Vec3& x) const {
    return glm::all(glm::greaterThanEqual(x, lower_)) && glm::all(glm::lessThanEqual(x, upper_));
  }
  [[nodiscard]] static bool bad() { return false; }
  [[nodiscard]] double size() const { return size_; }
  [[nodiscard]] Pack4 velocity(const Pack4& y) const { return {sign_ * formula_->velocity(y.xyz()), 0.0}; }
  [[nodiscard]] Pack4 along(const Pack4& y, const Pack4& d) const {
    return {sign_ * (formula_->jacobian(y.xyz()) * d.xyz()), 0.0};
  }
  [[nodiscard]] Mat3 jacobian(const Pack4& y) const { return sign_ * formula_->jacobian(y.xyz()); }
  [[nodiscard]] Crossing predict(const Pack4& y, const Pack4& n, const Pack4& curvature, int entry) const {
    Crossing first;
    for (int face = 0; face < 6; ++face) {
      const double value = face == entry ? 0.0 : face_value(face, y);
      const double s = first_root(value, face_rate(face, n), face_rate(face, curvature), kGrazing * size_);
      if (s < first.distance) first = {face, s};
    }
    return first;
  }
  [[nodiscard]] bool cross(int face, Pack4& y, int&) const {
    const int axis = face >> 1;
    y.set(axis, (face & 1) != 0 ? upper_[axis] : lower_[axis]);
    return false;
  }

 private:
  const AnalyticField* formula_;
  double sign_;
  double size_ = 1.0;
};

}  // namespace palpate
