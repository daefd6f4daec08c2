/// Flows in time with closed forms of where their particles go, sampled on grids of every kind.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/field/analytic/analytic_field.h"
#include "common/field/vector_field.h"
#include "common/trace/unsteady/trace_unsteady.h"
#include "tests/support/sampled.h"

namespace palpate::test {

/// What a flow in time is at one moment, on [-1, 1]^3.
class AtMoment final : public AnalyticField {
 public:
  explicit AtMoment(std::function<Vec3(const Vec3&)> v) : v_(std::move(v)) {}
  [[nodiscard]] Vec3 velocity(const Vec3& x) const noexcept override { return v_(x); }
  [[nodiscard]] Mat3 jacobian(const Vec3& x) const noexcept override {
    constexpr double kStep = 1e-4;  // of linear flows, exact up to rounding
    Mat3 m{0.0};
    for (int j = 0; j < 3; ++j) {
      Vec3 d{0.0};
      d[j] = kStep;
      m[j] = (v_(x + d) - v_(x - d)) / (2.0 * kStep);
    }
    return m;
  }
  [[nodiscard]] Box bounds() const noexcept override { return {Vec3{-1.0}, Vec3{1.0}}; }
  [[nodiscard]] std::string name() const override { return "at a moment"; }
  [[nodiscard]] std::string description() const override { return "at a moment"; }

 private:
  std::function<Vec3(const Vec3&)> v_;
};

/// A rotation about z whose rate swings while all is swept to and fro along z:
///
///   v = W'(t) (-y, x, 0) + Z'(t) e_z,   W(t) = t + 0.4 sin 2t,   Z(t) = 0.2 sin 3t.
///
/// A particle turns by W(t) - W(s) and rises by Z(t) - Z(s) from s to t.
struct SwingingTurn {
  static double angle(double t) { return t + 0.4 * std::sin(2.0 * t); }
  static double height(double t) { return 0.2 * std::sin(3.0 * t); }
  [[nodiscard]] static Vec3 velocity(double t, const Vec3& x) {
    const double rate = 1.0 + 0.8 * std::cos(2.0 * t);
    return {-rate * x.y, rate * x.x, 0.6 * std::cos(3.0 * t)};
  }
  [[nodiscard]] static Vec3 carried(const Vec3& x, double from, double to) {
    const double a = angle(to) - angle(from), c = std::cos(a), s = std::sin(a);
    return {c * x.x - s * x.y, s * x.x + c * x.y, x.z + height(to) - height(from)};
  }
};

/// Steps 0, dt, 2 dt, ... of a run.
inline std::vector<double> steps_until(double end, int intervals) {
  std::vector<double> times;
  for (int i = 0; i <= intervals; ++i) times.push_back(end * i / intervals);
  return times;
}

inline std::shared_ptr<const VectorField> field_of(const DataSet& block) {
  const DataArray& array = block.arrays.front();
  const ArrayInfo info{array.name, array.association, 3, array.type, array.tuples};
  return make_vector_field({block}, choose_vector({info}, array.name, "test"), "test");
}

enum class Grid { kFormula, kUniform, kRectilinear, kCurvilinear, kTetrahedra };
inline constexpr Grid kGrids[] = {Grid::kFormula, Grid::kUniform, Grid::kRectilinear, Grid::kCurvilinear,
                                  Grid::kTetrahedra};

inline std::shared_ptr<const VectorField> at_moment(Grid grid, std::function<Vec3(const Vec3&)> v) {
  const auto formula = std::make_shared<AtMoment>(std::move(v));
  constexpr SampledType kDouble = SampledType::kFloat64;
  switch (grid) {
    case Grid::kFormula:
      return make_vector_field(formula);
    case Grid::kUniform:
      return field_of(sample_uniform(*formula, Index3{7}, kDouble));
    case Grid::kRectilinear:
      return field_of(sample_rectilinear(*formula, Index3{7}, 3.0, kDouble));
    case Grid::kCurvilinear:
      return field_of(sample_curvilinear(*formula, Index3{6}, 0.25, kDouble));
    case Grid::kTetrahedra:
      break;
  }
  return field_of(sample_tetrahedra(*formula, Index3{6}, 0.2, 1, kDouble));
}

/// Reads SwingingTurn at the times given.
inline StepReader swinging(Grid grid, const std::vector<double>& times) {
  return [grid, times](std::size_t step) {
    return at_moment(grid, [t = times[step]](const Vec3& x) { return SwingingTurn::velocity(t, x); });
  };
}

}  // namespace palpate::test
