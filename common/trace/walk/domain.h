/// Where a line is followed by the general methods: the kernel of one cell and its faces. Frame L.
///
/// A domain holds one loaded cell, whose formula continues smoothly past the faces: velocity() and gradient()
/// may be asked anywhere near it. Positions are Pack4 with the time in the last lane, which the kernels
/// ignore; velocities have 0 there. Faces are affine functions of position, positive inside; where a face's
/// value counts as zero (`entry`), the cell was entered by it; face_scale() is about the largest value inside.
/// predict() looks for the first crossing within `reach` along the line.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "common/base/index.h"
#include "common/field/analytic/analytic_field.h"
#include "common/field/grid/box_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/vector_field.h"
#include "common/math/pack4.h"
#include "common/trace/exact/exact_walk.h"
#include "common/trace/walk/tet_crossing.h"
#include "common/trace/walk/walk_state.h"

namespace palpate {

/// Depth behind a face, relative to the numbers it is computed from, that is rounding: face_rounding().
inline constexpr double kGrazing = 4.0 * std::numeric_limits<double>::epsilon();

/// The first crossing that a parabola predicts.
struct Crossing {
  int face = -1;
  double distance = HUGE_VAL;
};

/// The velocity's derivatives by x, y and z.
struct FlowGradient {
  std::array<Pack4, 3> column;

  /// Jacobian times d.
  [[nodiscard]] Pack4 along(const Pack4& d) const {
    return (d.lo[0] * column[0] + d.lo[1] * column[1]) + d.hi[0] * column[2];
  }
  /// dv_i/dx_j at [j][i].
  [[nodiscard]] Mat3 matrix() const { return {column[0].xyz(), column[1].xyz(), column[2].xyz()}; }
};

/// Whether value + rate s + curvature s^2 / 2 stays positive for 0 < s <= reach, by a quick bound. Not so
/// where `value` is negative: a point behind a face by rounding has crossed it.
[[nodiscard]] inline bool stays_positive(double value, double rate, double curvature, double reach) {
  const double slope = std::min(0.0, rate + 0.5 * reach * std::min(0.0, curvature));
  return slope == 0.0 ? value >= 0.0 : value + reach * slope > 0.0;
}

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
    constexpr unsigned kAxes = 0b111u;
    const unsigned above = bits(lower_ <= y) & kAxes, below = bits(y <= upper_) & kAxes;
    if ((above & below) == kAxes) return true;
    if (reached < 0) return false;
    const unsigned own = 1u << (reached >> 1);
    return ((reached & 1) != 0 ? above & (below | own) : (above | own) & below) == kAxes;
  }

 protected:
  Pack4 lower_, upper_;
};

/// A uniform or rectilinear grid.
class BoxDomain : public BoxFaces {
 public:
  BoxDomain(const VectorField& field, double sign);

  [[nodiscard]] bool locate(const Vec3& x) {
    if (!grid_->locate(x, index_)) return false;
    load();
    return true;
  }
  /// @name LineWalk::cell(), and what save() keeps of the domain
  /// @{
  [[nodiscard]] std::int64_t cell() const {
    const std::int64_t row = grid_->points().x - 1, column = grid_->points().y - 1;
    return index_.x + row * (index_.y + column * index_.z);
  }
  void save(StateWriter& out) const { out(index_); }
  void restore(StateReader& in) {
    in(index_);
    load();
  }
  /// @}
  [[nodiscard]] bool bad() const { return bad_; }
  /// Speeds in this cell below which the flow is at rest: rest_speed.h where a corner rests (exact_mesh.h), else 0.
  [[nodiscard]] double rest_speed() const { return rest_here_; }
  /// By which velocities in this cell may be off, as its data are of single precision.
  [[nodiscard]] double data_error() const { return data_error_; }
  [[nodiscard]] double size() const { return size_; }
  [[nodiscard]] double face_scale() const { return size_; }

  [[nodiscard]] Pack4 velocity(const Pack4& y) const {
    const Pack4 d = y - corner_;
    const double dx = d.lo[0], dy = d.lo[1], dz = d.hi[0];
    return ((c_[0] + dx * c_[1]) + dy * (c_[2] + dx * c_[4])) +
           dz * ((c_[3] + dx * c_[6]) + dy * (c_[5] + dx * c_[7]));
  }
  [[nodiscard]] double face_rounding(int face, const Pack4& y) const {
    return kGrazing * (size_ + std::abs(y[face >> 1]));
  }
  [[nodiscard]] FlowGradient gradient(const Pack4& y) const {
    const Pack4 d = y - corner_;
    const double dx = d.lo[0], dy = d.lo[1], dz = d.hi[0];
    return {(c_[1] + dy * c_[4]) + dz * (c_[6] + dy * c_[7]),
            (c_[2] + dx * c_[4]) + dz * (c_[5] + dx * c_[7]),
            (c_[3] + dy * c_[5]) + dx * (c_[6] + dy * c_[7])};
  }

  [[nodiscard]] Crossing predict(const Pack4& y, const Pack4& n, const Pack4& curvature, int entry,
                                 double reach) const {
    // The face ahead of each axis; the one behind only where the curve may turn back to it. Most are farther
    // than the curve goes: |n| s + |curvature| s^2 / 2 at most.
    const Pack4 zero, speed = abs(n);
    const Mask4 up = zero < n;
    const Pack4 turn = (0.5 * reach) * select(up, curvature, zero - curvature);
    const Pack4 below = y - lower_, above = upper_ - y;
    constexpr unsigned kAxes = 0b111u;
    const unsigned upward = bits(up);
    unsigned ahead = bits(select(up, above, below) <= reach * (speed + max(turn, zero))) & kAxes;
    unsigned behind = bits(select(up, below, above) <= reach * (zero - turn - speed)) & kAxes;
    Crossing first;
    for (; ahead != 0u; ahead &= ahead - 1u) {
      const int axis = std::countr_zero(ahead);
      consider(2 * axis + static_cast<int>(upward >> axis & 1u), y, n, curvature, entry, first);
    }
    for (; behind != 0u; behind &= behind - 1u) {
      const int axis = std::countr_zero(behind);
      consider(2 * axis + 1 - static_cast<int>(upward >> axis & 1u), y, n, curvature, entry, first);
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
  void consider(int face, const Pack4& y, const Pack4& n, const Pack4& curvature, int entry,
                Crossing& first) const {
    const double value = face == entry ? 0.0 : face_value(face, y);
    const double s =
        first_root(value, face_rate(face, n), face_rate(face, curvature), face_rounding(face, y));
    if (s < first.distance) first = {face, s};
  }

  void load() {
    BoxCell cell;
    grid_->load(index_, *values_, cell);
    bad_ = cell.bad_data;
    const Corners corners = corners_of(cell);
    rest_here_ = has_resting_corner(slow_ones(corners)) ? rest_speed_ : 0.0;
    data_error_ = error_of_data(cell, corners);
    corner_ = Pack4{cell.lower, 0.0};
    // Of x - lo rather than of u: a product less in each evaluation.
    const Vec3& inverse = cell.inverse_size;
    const double xy = inverse.x * inverse.y;
    const std::array<double, 8> factor{
        1.0,           inverse.x, inverse.y, inverse.z, xy, inverse.y * inverse.z, inverse.z * inverse.x,
        xy * inverse.z};
    for (std::size_t k = 0; k < 8; ++k) c_[k] = Pack4{(sign_ * factor[k]) * cell.c[k], 0.0};
    for (int axis = 0; axis < 3; ++axis) {
      lower_.set(axis, grid_->coordinate(axis, index_[axis]));
      upper_.set(axis, grid_->coordinate(axis, index_[axis] + 1));
    }
    size_ = std::max(cell.size.x, std::max(cell.size.y, cell.size.z));
  }

  /// The velocities at the corners of a cell, x first.
  using Corners = std::array<Pack4, 8>;
  [[nodiscard]] static Corners corners_of(const BoxCell& cell);
  /// A bit for each corner that is no faster than rest_speed_.
  [[nodiscard]] unsigned slow_ones(const Corners& corners) const;
  [[nodiscard]] bool has_resting_corner(unsigned slow) const;
  [[nodiscard]] double error_of_data(const BoxCell& cell, const Corners& corners) const;

  const BoxGrid* grid_;
  const PointVectors* values_;
  double sign_;
  double rest_speed_ = 0.0, value_rounding_, point_rounding_;
  Index3 index_{0};
  bool bad_ = false;
  double rest_here_ = 0.0, data_error_ = 0.0;
  double size_ = 1.0;
  Pack4 corner_;
  std::array<Pack4, 8> c_;  ///< coefficients of (1) of box_grid.h, for x - lo
};

/// A tetrahedral mesh with linear interpolation.
class TetDomain {
 public:
  TetDomain(const ExactMesh& mesh, double sign);

  [[nodiscard]] bool locate(const Vec3& x);
  [[nodiscard]] std::int64_t cell() const { return cell_; }
  void save(StateWriter& out) const { out(cell_, crossed_seam_, seam_, stuck_, last_seam_); }
  void restore(StateReader& in);
  [[nodiscard]] bool bad() const { return bad_; }
  /// Speeds in this cell below which the flow is at rest: rest_speed.h where a corner rests, else 0.
  [[nodiscard]] double rest_speed() const { return rest_here_; }
  [[nodiscard]] double size() const { return size_; }
  [[nodiscard]] static double face_scale() { return 1.0; }

  [[nodiscard]] Pack4 velocity(const Pack4& y) const { return origin_ + gradient_.along(y - corner_); }
  [[nodiscard]] const FlowGradient& gradient(const Pack4&) const { return gradient_; }

  [[nodiscard]] static constexpr int face_count() { return 4; }
  [[nodiscard]] bool inside(const Pack4& y, int reached) const {
    bool in = true;
    constexpr double kRounding = -1e-14;
    for (int face = 0; face < 4; ++face) in = in && (face == reached || face_value(face, y) >= kRounding);
    return in;
  }
  [[nodiscard]] double face_value(int face, const Pack4& y) const {
    const auto i = as_size(face);
    return face_offset_[i] + glm::dot(face_[i], (y - corner_).xyz());
  }
  [[nodiscard]] double face_rate(int face, const Pack4& d) const {
    return glm::dot(face_[as_size(face)], d.xyz());
  }
  [[nodiscard]] static double face_rounding(int, const Pack4&) { return kGrazing; }
  [[nodiscard]] Crossing predict(const Pack4& y, const Pack4& n, const Pack4& curvature, int entry,
                                 double reach) const {
    Crossing first;
    for (int face = 0; face < 4; ++face) {
      const double value = face == entry ? 0.0 : face_value(face, y);
      const double rate = face_rate(face, n), bend = face_rate(face, curvature);
      if (stays_positive(value, rate, bend, reach)) continue;
      const double s = first_root(value, rate, bend, face_rounding(face, y));
      if (s < first.distance) first = {face, s};
    }
    return first;
  }
  [[nodiscard]] bool cross(int face, Pack4& y, int& entry);
  /// By which velocities in this cell may be off: those of curved cells, and as its data are of single precision.
  [[nodiscard]] double data_error() const { return data_error_; }
  /// The last cross() led to a cell that shares no points with the one before: the velocity may jump.
  [[nodiscard]] bool crossed_seam() const { return crossed_seam_; }
  /// What is known of that.
  [[nodiscard]] const SeamCrossing& seam() const { return seam_; }

 private:
  void load(CellIndex cell);
  [[nodiscard]] bool cross_border(int face, Pack4& y, int& entry);

  const ExactMesh* mesh_;
  double sign_;
  CellIndex cell_ = kNoCell;
  bool bad_ = false;
  double rest_here_ = 0.0, data_error_ = 0.0;
  bool crossed_seam_ = false;
  SeamCrossing seam_;
  int stuck_ = 0;  ///< crossings of seams at one place
  Vec3 last_seam_{HUGE_VAL};
  double size_ = 1.0;
  Pack4 corner_, origin_;
  FlowGradient gradient_;
  std::array<Vec3, 4> face_{};           ///< gradients of the barycentric coordinates
  std::array<double, 4> face_offset_{};  ///< their values at the corner
};

/// A formula; the only faces are its bounds.
class FormulaDomain : public BoxFaces {
 public:
  FormulaDomain(const VectorField& field, double sign) : formula_(field.analytic()), sign_(sign) {
    const Box box = formula_->bounds();
    lower_ = Pack4{box.lower, 0.0};
    upper_ = Pack4{box.upper, 0.0};
    size_ = box.diagonal();
  }

  [[nodiscard]] bool locate(const Vec3& x) const { return inside(Pack4{x, 0.0}, -1); }
  [[nodiscard]] static std::int64_t cell() { return -1; }
  static void save(StateWriter&) {}
  static void restore(StateReader&) {}
  [[nodiscard]] static bool bad() { return false; }
  [[nodiscard]] static double rest_speed() { return 0.0; }
  [[nodiscard]] double size() const { return size_; }
  [[nodiscard]] double face_scale() const { return size_; }
  [[nodiscard]] Pack4 velocity(const Pack4& y) const { return {sign_ * formula_->velocity(y.xyz()), 0.0}; }
  [[nodiscard]] double face_rounding(int, const Pack4&) const { return kGrazing * size_; }
  [[nodiscard]] FlowGradient gradient(const Pack4& y) const {
    const Mat3 j = sign_ * formula_->jacobian(y.xyz());
    return {Pack4{j[0], 0.0}, Pack4{j[1], 0.0}, Pack4{j[2], 0.0}};
  }
  [[nodiscard]] Crossing predict(const Pack4& y, const Pack4& n, const Pack4& curvature, int entry,
                                 double reach) const {
    Crossing first;
    for (int face = 0; face < 6; ++face) {
      const double value = face == entry ? 0.0 : face_value(face, y);
      if (stays_positive(value, face_rate(face, n), face_rate(face, curvature), reach)) continue;
      const double s =
          first_root(value, face_rate(face, n), face_rate(face, curvature), face_rounding(face, y));
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
