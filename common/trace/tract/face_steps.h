/// How error-controlled steps deal with the faces between cells, where interpolated tensors have kinks.
///
/// Of a kink within a step an embedded pair says too little: the estimate of Dormand and Prince's 5(4) is a thirteenth of what
/// the solution is off, in the mean over where in the step the kink lies, and by chance nothing. What no parabola in time
/// explains of the slopes of all stages is never nothing there: for a jump J of their derivative at any place of the step the
/// solution is off by at most 0.95 h |r|, in the mean by 0.16 h |r|, where r is what is left of the slopes. So of a step of
/// length h over faces
///
///   estimate = max(e, 0.45 h |r|),        c = max(0.45 |r| / h, 0.9 c)                                    (1)
///
/// where e is what the pair says. What kinks do to a step is their jump times h^2 (Hairer, Norsett and Wanner 1993, II.6):
/// where the longest step that c lets over faces would be shorter than a cell, steps end at the first face that they come to,
/// and go on from there.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "common/base/index.h"
#include "common/field/field_grid.h"
#include "common/field/grid/box_grid.h"
#include "common/math/vec.h"

namespace palpate {

/// What is left of the slopes of a step less the parabola in time that fits them best: their products with the orthogonal
/// polynomials of higher degrees on the stages' times. The last stage stands for both that sit at the end.
template <class Tableau>
class SlopeRest {
  static_assert(Tableau::kFirstSameAsLast && Tableau::c[Tableau::kStages - 2] == 1.0);
  static constexpr std::size_t kTimes = Tableau::kStages - 1;
  static constexpr std::size_t kExplained = 3;  ///< a parabola's coefficients
  using Values = std::array<double, kTimes>;

 public:
  /// Its square. @param dot scalar product of two slopes.
  template <class Slopes, class Dot>
  [[nodiscard]] static auto square(const Slopes& k, const Dot& dot) {
    auto sum = part(k, kExplained, dot);
    for (std::size_t degree = kExplained + 1; degree < kTimes; ++degree) sum = sum + part(k, degree, dot);
    return sum;
  }

 private:
  template <class Slopes, class Dot>
  [[nodiscard]] static auto part(const Slopes& k, std::size_t degree, const Dot& dot) {
    const Values& p = kPolynomials[degree];
    auto sum = p[kTimes - 1] * k[kTimes];
    for (std::size_t i = 0; i + 1 < kTimes; ++i) sum += p[i] * k[i];
    return (1.0 / product(p, p)) * dot(sum, sum);
  }
  static constexpr double product(const Values& a, const Values& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < kTimes; ++i) sum += a[i] * b[i];
    return sum;
  }
  /// By degree, each orthogonal to all before it.
  static constexpr std::array<Values, kTimes> kPolynomials = [] {
    std::array<Values, kTimes> all{};
    for (std::size_t degree = 0; degree < kTimes; ++degree) {
      Values& p = all[degree];
      for (std::size_t i = 0; i < kTimes; ++i)
        p[i] = degree == 0 ? 1.0 : Tableau::c[i + 1 < kTimes ? i : kTimes] * all[degree - 1][i];
      for (std::size_t lower = 0; lower < degree; ++lower) {
        const double share = product(p, all[lower]) / product(all[lower], all[lower]);
        for (std::size_t i = 0; i < kTimes; ++i) p[i] -= share * all[lower][i];
      }
    }
    return all;
  }();
};

class FaceSteps {
 public:
  /// In frame S of tensor_source.h. Of a grid without a box the faces are not known: any step may go over some, and none
  /// ends there. @param tolerance local error per arc length.
  FaceSteps(const FieldGrid& grid, double tolerance) : tolerance_(tolerance) {
    near_ = std::min(kNearest, kNear * std::sqrt(tolerance));
    if (grid.box == nullptr) return;
    const Mat3 along = grid.frame.rotation * grid.box->gradients();
    width_ = HUGE_VAL;
    for (int axis = 0; axis < 3; ++axis) {
      Axis& a = axes_[as_size(axis)];
      a.row = along[axis];
      a.cells = grid.box->points()[axis] - 1;
      a.first = grid.box->coordinate(axis, 0);
      a.mean_width = (grid.box->coordinate(axis, a.cells) - a.first) / a.cells;
      width_ = std::min(width_, a.mean_width);
      if (grid.box->uniform()) continue;
      for (int i = 0; i <= a.cells; ++i) a.coordinates.push_back(grid.box->coordinate(axis, i));
    }
  }

  /// Another line begins.
  void restart() noexcept {
    kink_ = 0.0;
    bend_ = Vec3{0.0};
  }

  /// The length of the next step from `x`, at most `wanted`; not below `shortest` but where a face is nearer.
  [[nodiscard]] double length(const Vec3& x, const Vec3& direction, double wanted, double shortest) noexcept {
    const double over_faces = kink_ > 0.0 ? tolerance_ / kink_ : HUGE_VAL;
    cut_ = over_faces < width_;
    if (!cut_) return std::min(wanted, std::max(shortest, kSafety * over_faces));
    return wanted * first_face(x, wanted * direction, (0.5 * wanted * wanted) * bend_);
  }

  /// What an estimate counts of a step of length `h` between two places. @param rest the square of SlopeRest.
  [[nodiscard]] double counted(const Vec3& from, const Vec3& to, double h, double estimate,
                               double rest) noexcept {
    const bool over = width_ == 0.0 || crosses(from, to);
    if (cut_) {
      kink_ *= kKept;  // so that one over faces is tried again
      return over ? kMissed * estimate : estimate;
    }
    if (!over) return estimate;
    const double off = kOff * std::sqrt(rest);
    kink_ = std::max(off / h, kKept * kink_);
    return std::max(estimate, h * off);
  }

  /// The step is taken: the length of the next one, where `proposed` is what its error says. One that was cut says nothing
  /// against the `wanted` one. @param turn change of direction over the length `h`.
  [[nodiscard]] double accept(double wanted, double proposed, const Vec3& turn, double h) noexcept {
    bend_ = turn / h;
    return cut_ ? std::max(wanted, proposed) : proposed;
  }

 private:
  static constexpr double kOff = 0.45;  ///< of (1); the built-in bundles keep what they state by it
  static constexpr double kKept = 0.9;
  static constexpr double kMissed = 20.0;  ///< an end that misses its face
  static constexpr double kSafety = 0.9;   ///< as StepControl's
  static constexpr double kNearest = 0.003,
                          kNear = 0.1;  ///< cells; a miss of e leaves a kink that counts as e h
  static constexpr int kCorrections = 3;

  struct Axis {
    Vec3 row{0.0};  ///< its product with a place is the coordinate
    double first = 0.0, mean_width = 1.0;
    int cells = 1;
    std::vector<double> coordinates;  ///< of a rectilinear grid
  };

  [[nodiscard]] static double coordinate(const Axis& a, int i) noexcept {
    return a.coordinates.empty() ? a.first + i * a.mean_width : a.coordinates[as_size(i)];
  }
  /// The cell that holds a coordinate; the nearest one of those outside.
  [[nodiscard]] static int cell_at(const Axis& a, double x) noexcept {
    if (a.coordinates.empty())
      return static_cast<int>(std::clamp((x - a.first) / a.mean_width, 0.0, a.cells - 0.5));
    const auto inner = a.coordinates.begin() + 1;
    return static_cast<int>(std::upper_bound(inner, a.coordinates.end() - 1, x) - inner);
  }
  [[nodiscard]] bool crosses(const Vec3& from, const Vec3& to) const noexcept {
    return std::ranges::any_of(axes_, [&](const Axis& a) {
      return cell_at(a, glm::dot(a.row, from)) != cell_at(a, glm::dot(a.row, to));
    });
  }

  /// The part of the way x + t linear + t^2 square, t in [0, 1], at whose end it is barely past its first face; 1 where it
  /// comes to none. A face that it begins at is not one. The image's border has no kink.
  [[nodiscard]] double first_face(const Vec3& x, const Vec3& linear, const Vec3& square) const noexcept {
    double first = 1.0;
    for (const Axis& a : axes_) {
      const double start = glm::dot(a.row, x), slope = glm::dot(a.row, linear),
                   bend = glm::dot(a.row, square);
      const double way = slope + bend;
      const int cell = cell_at(a, start);
      const double lower = coordinate(a, cell), upper = coordinate(a, cell + 1),
                   near = near_ * (upper - lower);
      const int face =
          way > 0.0 ? cell + (upper - start > near ? 1 : 2) : cell - (start - lower > near ? 0 : 1);
      if (way == 0.0 || face < 1 || face >= a.cells) continue;
      const double ahead = coordinate(a, face) - start + std::copysign(kPast * near, way);
      double t = ahead / way;
      if (t >= 1.0) continue;
      for (int n = 0; n < kCorrections; ++n)
        t = std::clamp(t - (t * (slope + t * bend) - ahead) / way, 0.0, 1.0);
      if (t > 0.0) first = std::min(first, t);
    }
    return first;
  }
  static constexpr double kPast = 0.3;  ///< nearnesses: short of a face would be worse

  double tolerance_, near_ = 0.0;
  double width_ = 0.0;  ///< the least mean width of cells; 0 where there is no box
  std::array<Axis, 3> axes_;
  double kink_ = 0.0;  ///< c of (1)
  Vec3 bend_{0.0};     ///< of the last step: change of direction over length
  bool cut_ = false;   ///< the step now tried ends at the first face
};

}  // namespace palpate
