/// The methods behind one face for the walk of a cell: try a step, ask for its end, error and dense output.
///
/// State: position and time (Pack4). Explicit methods follow v/|v| and 1/|v|, so that their step h is arc length
/// and slow regions cost no more than others. A stiff method follows v / c, with c the speed where the step
/// begins: stages lie off a slow manifold by what the flow forgets at once, but which turns v/|v| and 1/|v|, and
/// held steps to sqrt(tolerance / rate). Its step is time times c, and the arc length that of the solution.
///
/// A `Flow` has velocity(y) with 0 in the last lane, slope(y) of the explicit methods, and gradient(y), a Mat3.
///
/// A step of a stiff() method may be longer than the flow's fastest rate allows: the slope at its end and its
/// derivative are then those of the fast directions, and say nothing of how the line goes on.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/base/index.h"
#include "common/math/pack4.h"
#include "common/math/vec.h"
#include "common/ode/explicit_step.h"
#include "common/ode/rosenbrock.h"
#include "common/ode/tableau.h"
#include "common/trace/walk/error_transport.h"

namespace palpate {

/// An explicit Runge-Kutta method.
template <class Tableau>
class ExplicitMethod {
 public:
  static constexpr bool kAdaptive = Tableau::kEmbeddedOrder > 0;
  /// Whether error() is that of the solution kept, to leading order, rather than one of lower order.
  static constexpr bool kEstimatesKept =
      kAdaptive ? Tableau::kOrder < Tableau::kEmbeddedOrder : Tableau::kOrder == 1;
  /// Whether TwoSteps is of the order of the error of the solution kept, or higher. Beside dp54 it would be the larger.
  static constexpr bool kLookedAtTwice = !kEstimatesKept && Tableau::kOrder <= 4;
  /// Order of the error per unit step.
  [[nodiscard]] static constexpr int power() {
    return kAdaptive ? std::min(Tableau::kOrder, Tableau::kEmbeddedOrder) : 1;
  }
  [[nodiscard]] static constexpr bool stiff() { return false; }
  static constexpr void restart() {}

  template <class Flow>
  bool attempt(const Flow& flow, const Pack4& y, const Pack4& first, double h) {
    step_.start = y;
    step_.step = h;
    step_.k[0] = first;
    const auto f = [&](double, const Pack4& x) { return flow.slope(x); };
    step_.advance(f);
    if constexpr (Tableau::kFirstSameAsLast) {
      step_.finish(f);
      last_ = step_.k[Tableau::kStages - 1];
    } else {
      last_ = flow.slope(step_.end);
    }
    return true;
  }
  [[nodiscard]] const Pack4& end() const { return step_.end; }
  [[nodiscard]] const Pack4& last_slope() const { return last_; }
  [[nodiscard]] double step() const { return step_.step; }
  /// Arc length of the part `theta` of the step.
  [[nodiscard]] double arc(double theta) const { return theta * step_.step; }

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
  /// R(h j) e.
  [[nodiscard]] static Vec3 stepped(const Mat3& j, const Vec3& e, double h) {
    return stability_step<Tableau>(j, e, h);
  }
  [[nodiscard]] auto dense() const { return step_.dense(); }
  /// h times the fastest rate of the direction, as far as the stages of the last step tell.
  [[nodiscard]] double fastest_rate() const {
    const auto length = [](const Pack4& d) { return std::sqrt(dot3(d, d)); };
    constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
    return step_.fastest_rate(length, kRounding * length(step_.end));
  }

 private:
  ExplicitStep<Tableau, Pack4> step_;
  Pack4 last_;
};

/// RODAS 4(3) with the Jacobian of the interpolant.
class RodasMethod {
 public:
  static constexpr bool kAdaptive = true;
  static constexpr bool kEstimatesKept = false, kLookedAtTwice = false;
  [[nodiscard]] static constexpr int power() { return 3; }
  [[nodiscard]] static constexpr bool stiff() { return true; }
  static constexpr void restart() {}

  template <class Flow>
  bool attempt(const Flow& flow, const Pack4& y, const Pack4& first, double h) {
    const double per_speed = first[3];
    const auto f = [&](const Step::Vector& x) {
      const Pack4 v = flow.velocity(Pack4{x[0], x[1], x[2], 0.0});
      return Step::Vector{per_speed * v[0], per_speed * v[1], per_speed * v[2]};
    };
    const Mat3 gradient = per_speed * flow.gradient(y);
    Step::Matrix j{};
    rate_ = 0.0;
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 3; ++row) j[as_size(row)][as_size(column)] = gradient[column][row];
      rate_ += glm::dot(gradient[column], gradient[column]);
    }
    h_ = h;
    per_speed_ = per_speed;
    step_.start = {y[0], y[1], y[2]};
    if (!step_.run_from(f, {first[0], first[1], first[2]}, j, h)) return false;
    end_ = Pack4{step_.end[0], step_.end[1], step_.end[2], y[3] + per_speed * h};
    last_ = flow.slope(end_);
    dense_ = step_.dense();
    return true;
  }
  [[nodiscard]] const Pack4& end() const { return end_; }
  [[nodiscard]] const Pack4& last_slope() const { return last_; }
  [[nodiscard]] double step() const { return h_; }
  /// Of the dense output, by Gauss's rule of four nodes.
  [[nodiscard]] double arc(double theta) const {
    constexpr std::array<double, 4> kNode{0.06943184420297371, 0.33000947820757187, 0.6699905217924281,
                                          0.9305681557970263};
    constexpr std::array<double, 4> kWeight{0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                            0.17392742256872693};
    double sum = 0.0;
    for (std::size_t i = 0; i < kNode.size(); ++i) {
      const double t = theta * kNode[i];
      double square = 0.0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double rate = dense_[0][axis] + t * (2.0 * dense_[1][axis] + t * 3.0 * dense_[2][axis]);
        square += rate * rate;
      }
      sum += kWeight[i] * std::sqrt(square);
    }
    return theta * sum;
  }
  [[nodiscard]] Pack4 error() const { return {step_.error[0], step_.error[1], step_.error[2], 0.0}; }
  /// R(h j) e: a step of x' = j x from e.
  [[nodiscard]] static Vec3 stepped(const Mat3& j, const Vec3& e, double h) {
    Step::Matrix rows{};
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 3; ++row) rows[as_size(row)][as_size(column)] = j[column][row];
    }
    const auto f = [&](const Step::Vector& x) {
      const Vec3 v = j * Vec3(x[0], x[1], x[2]);
      return Step::Vector{v.x, v.y, v.z};
    };
    Step step;
    return step.run(f, rows, {e.x, e.y, e.z}, h) ? Vec3(step.end[0], step.end[1], step.end[2]) : Vec3{0.0};
  }
  [[nodiscard]] std::array<Pack4, 3> dense() const {
    const auto pack = [](const Step::Vector& x, double time) { return Pack4{x[0], x[1], x[2], time}; };
    return {pack(dense_[0], per_speed_ * h_), pack(dense_[1], 0.0), pack(dense_[2], 0.0)};
  }
  /// A bound of h times the fastest rate of the flow, at the beginning of the last step.
  [[nodiscard]] double fastest_rate() const { return h_ * std::sqrt(rate_); }

 private:
  using Step = RodasStep<3>;
  Step step_;
  std::array<Step::Vector, 3> dense_{};
  Pack4 end_, last_;
  double h_ = 0.0;
  double per_speed_ = 0.0;  ///< 1 / c
  double rate_ = 0.0;       ///< square of the Jacobian's norm
};

/// Dormand-Prince 5(4) where its steps are limited by accuracy, RODAS 4(3) where they would be by stability:
/// goes over where the fastest rate says so step after step, and back where it would no longer, well apart
/// (Petzold 1983; Hairer and Wanner 1996, IV.2).
class SwitchingMethod {
 public:
  static constexpr bool kAdaptive = true;
  static constexpr bool kEstimatesKept = false, kLookedAtTwice = false;
  [[nodiscard]] int power() const { return stiff_ ? RodasMethod::power() : Explicit::power(); }
  [[nodiscard]] bool stiff() const { return stiff_; }
  /// Forgets what the last line was like.
  void restart() {
    stiff_ = false;
    looks_ = signs_ = contrary_ = 0;
  }

  template <class Flow>
  bool attempt(const Flow& flow, const Pack4& y, const Pack4& first, double h) {
    return stiff_ ? implicit_.attempt(flow, y, first, h) : explicit_.attempt(flow, y, first, h);
  }
  [[nodiscard]] const Pack4& end() const { return stiff_ ? implicit_.end() : explicit_.end(); }
  [[nodiscard]] const Pack4& last_slope() const {
    return stiff_ ? implicit_.last_slope() : explicit_.last_slope();
  }
  [[nodiscard]] double step() const { return stiff_ ? implicit_.step() : explicit_.step(); }
  [[nodiscard]] double arc(double theta) const {
    return stiff_ ? implicit_.arc(theta) : explicit_.arc(theta);
  }
  [[nodiscard]] Pack4 error() const { return stiff_ ? implicit_.error() : explicit_.error(); }
  [[nodiscard]] Vec3 stepped(const Mat3& j, const Vec3& e, double h) const {
    return stiff_ ? RodasMethod::stepped(j, e, h) : Explicit::stepped(j, e, h);
  }
  [[nodiscard]] std::array<Pack4, Dp54::kDenseDegree> dense() const {
    if (!stiff_) return explicit_.dense();
    const auto q = implicit_.dense();
    return {q[0], q[1], q[2]};
  }

  /// Looks at the accepted step. True where the next one is another method's; what was asked of this one is
  /// then lost.
  [[nodiscard]] bool goes_over() {
    // The scheme of Hairer's DOPRI5. Few flows are stiff, so that a look now and then does until one seems so.
    constexpr int kBetweenLooks = 8;
    if (!stiff_ && signs_ == 0 && ++looks_ % kBetweenLooks != 0) return false;
    constexpr double kStable = 1.75;  // of the 3.3 to which dp54 is stable; its order falls before that
    constexpr double kCalm = 0.8;
    constexpr int kEnough = 15, kEnoughBack = 6, kContrary = 6;
    const double rate = stiff_ ? implicit_.fastest_rate() : explicit_.fastest_rate();
    if (stiff_ ? rate < kCalm : rate > kStable) {
      contrary_ = 0;
      if (++signs_ < (stiff_ ? kEnoughBack : kEnough)) return false;
      stiff_ = !stiff_;
      signs_ = 0;
      return true;
    }
    if (++contrary_ >= kContrary) signs_ = 0;
    return false;
  }

 private:
  using Explicit = ExplicitMethod<Dp54>;
  Explicit explicit_;
  RodasMethod implicit_;
  bool stiff_ = false;
  int looks_ = 0;
  int signs_ = 0;     ///< steps that spoke for the other method
  int contrary_ = 0;  ///< steps that spoke against it, since the last that spoke for it
};

}  // namespace palpate
