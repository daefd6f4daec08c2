/// The methods behind one face for the walk of a cell: try a step, ask for its end, error and dense output.
///
/// State: position and time (Pack4). Slope: v/|v| and 1/|v|, so the independent variable is arc length.
#pragma once

#include <algorithm>
#include <array>

#include "common/math/pack4.h"
#include "common/ode/explicit_step.h"
#include "common/ode/rosenbrock.h"
#include "common/ode/tableau.h"

namespace palpate {

/// An explicit Runge-Kutta method.
template <class Tableau>
class ExplicitMethod {
 public:
  static constexpr bool kAdaptive = Tableau::kEmbeddedOrder > 0;
  /// Order of the error per unit step.
  static constexpr int kPower = kAdaptive ? std::min(Tableau::kOrder, Tableau::kEmbeddedOrder) : 1;

  /// Whether error() is that of the solution kept, to leading order, rather than one of lower order.
  static constexpr bool kEstimatesKept =
      kAdaptive ? Tableau::kOrder < Tableau::kEmbeddedOrder : Tableau::kOrder == 1;

  template <class Slope, class Jacobian>
  bool attempt(const Slope& slope, const Jacobian&, const Pack4& y, const Pack4& first, double h) {
    step_.start = y;
    step_.step = h;
    step_.k[0] = first;
    const auto f = [&](double, const Pack4& x) { return slope(x); };
    step_.advance(f);
    if constexpr (Tableau::kFirstSameAsLast) {
      step_.finish(f);
      last_ = step_.k[Tableau::kStages - 1];
    } else {
      last_ = slope(step_.end);
    }
    return true;
  }
  [[nodiscard]] const Pack4& end() const { return step_.end; }
  [[nodiscard]] const Pack4& last_slope() const { return last_; }
  [[nodiscard]] double step() const { return step_.step; }

  /// Estimate of the local error. The fixed-step methods have no embedded partner; with the slope at the end
  /// one more is known: Euler beside the trapezoidal rule; RK4 beside the third-order method whose last
  /// weight goes to that slope (it meets the same conditions up to order three).
  [[nodiscard]] Pack4 error() const {
    if constexpr (kAdaptive) {
      return step_.error();
    } else if constexpr (Tableau::kOrder == 1) {
      return (0.5 * step_.step) * (last_ - step_.k[0]);
    } else {
      return (step_.step * Tableau::b[Tableau::kStages - 1]) * (last_ - step_.k[Tableau::kStages - 1]);
    }
  }
  [[nodiscard]] auto dense() const { return step_.dense(); }

 private:
  ExplicitStep<Tableau, Pack4> step_;
  Pack4 last_;
};

/// RODAS 4(3) with the Jacobian of the interpolant.
class RodasMethod {
 public:
  static constexpr bool kAdaptive = true;
  static constexpr bool kEstimatesKept = false;
  static constexpr int kPower = 3;

  template <class Slope, class Jacobian>
  bool attempt(const Slope& slope, const Jacobian& jacobian, const Pack4& y, const Pack4& first, double h) {
    using Step = RodasStep<4>;
    step_.start = array(y);
    h_ = h;
    const auto f = [&](const Step::Vector& x) { return array(slope(pack(x))); };
    if (!step_.run_from(f, array(first), jacobian(y, first), h)) return false;
    end_ = pack(step_.end);
    last_ = slope(end_);
    return true;
  }
  [[nodiscard]] const Pack4& end() const { return end_; }
  [[nodiscard]] const Pack4& last_slope() const { return last_; }
  [[nodiscard]] double step() const { return h_; }
  [[nodiscard]] Pack4 error() const { return pack(step_.error); }
  [[nodiscard]] std::array<Pack4, 3> dense() const {
    const auto q = step_.dense();
    return {pack(q[0]), pack(q[1]), pack(q[2])};
  }

 private:
  static std::array<double, 4> array(const Pack4& y) { return {y[0], y[1], y[2], y[3]}; }
  static Pack4 pack(const std::array<double, 4>& y) { return {y[0], y[1], y[2], y[3]}; }

  RodasStep<4> step_;
  Pack4 end_, last_;
  double h_ = 0.0;
};

}  // namespace palpate
