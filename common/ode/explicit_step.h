/// One step of an explicit Runge-Kutta method (tableau.h), stage by stage.
///
/// `State` is any type with `a + b`, `a += b` and `double * a`. A caller that knows the first slope gives
/// it; one that wants the last stage elsewhere (a tracer that lands on a cell face) calls advance() and
/// then sets the last slope itself.
#pragma once

#include <array>
#include <cstddef>
#include <utility>

namespace palpate {

template <class Tableau, class State>
struct ExplicitStep {
  static constexpr int kStages = Tableau::kStages;

  State start{};                   ///< x
  State end{};                     ///< x_1
  double step = 0.0;               ///< h
  std::array<State, kStages> k{};  ///< slopes; k[0] is set by the caller

  /// All stages but one that sits at x_1, and x_1. @pre `start`, `step` and k[0] are set.
  template <class Slope>
  void advance(const Slope& f, double t = 0.0) {
    constexpr int kInner = Tableau::kFirstSameAsLast ? kStages - 1 : kStages;
    stages_from<1, kInner>(f, t);
    end = start;
    add_weighted<kStages>(Tableau::b, end);
  }

  /// The last stage, at x_1, where the method has one.
  template <class Slope>
  void finish(const Slope& f, double t = 0.0) {
    if constexpr (Tableau::kFirstSameAsLast) k[kStages - 1] = f(t + step, end);
  }

  /// The whole step.
  template <class Slope>
  void run(const Slope& f, double t, const State& x, double h) {
    start = x;
    step = h;
    k[0] = f(t, x);
    advance(f, t);
    finish(f, t);
  }

  /// Kept minus embedded solution. @pre the last stage is set.
  [[nodiscard]] State error() const {
    State sum = (step * Tableau::e[0]) * k[0];
    add_weighted<kStages, 1>(Tableau::e, sum);
    return sum;
  }

  /// h times the rate at which the slope changes fastest, as far as the last two stages tell, both of which sit
  /// at t + h: |h (k_s - k_(s-1))| over the distance of their arguments (Hairer and Wanner 1996, IV.2). 0 where
  /// the arguments differ by no more than `rounding`. `length(state)` measures. @pre the last stage is set.
  template <class Length>
  [[nodiscard]] double fastest_rate(const Length& length, double rounding) const {
    static_assert(Tableau::kFirstSameAsLast && Tableau::c[kStages - 2] == 1.0);
    State apart{};
    add_weighted<kStages - 1>(kLastTwo, apart);
    const double distance = length(apart);
    return distance > rounding ? length(step * (k[kStages - 1] - k[kStages - 2])) / distance : 0.0;
  }

  /// Coefficients q_j of the dense output x + sum_j q_j theta^(j+1).
  [[nodiscard]] std::array<State, Tableau::kDenseDegree> dense() const {
    std::array<State, Tableau::kDenseDegree> q{};
    fill_dense(q, std::make_index_sequence<Tableau::kDenseDegree>{});
    return q;
  }

 private:
  /// Weights of the difference between the arguments of the last two stages.
  static constexpr typename Tableau::Row kLastTwo = [] {
    typename Tableau::Row w{};
    for (int j = 0; j < kStages - 1; ++j) w[j] = Tableau::b[j] - Tableau::a[kStages - 2][j];
    return w;
  }();

  template <int kStage, int kEnd, class Slope>
  void stages_from(const Slope& f, double t) {
    if constexpr (kStage < kEnd) {
      State x = start;
      add_weighted<kStage>(Tableau::a[kStage], x);
      k[kStage] = f(t + Tableau::c[kStage] * step, x);
      stages_from<kStage + 1, kEnd>(f, t);
    }
  }

  /// sum += h sum_i w_i k_i over kFirst <= i < kCount. The weights are compile-time constants at every call,
  /// so zero ones cost nothing after inlining.
  template <int kCount, int kFirst = 0>
  void add_weighted(const typename Tableau::Row& w, State& sum) const {
    if constexpr (kFirst < kCount) {
      if (w[kFirst] != 0.0) sum += (step * w[kFirst]) * k[kFirst];
      add_weighted<kCount, kFirst + 1>(w, sum);
    }
  }

  template <std::size_t... kPower>
  void fill_dense(std::array<State, Tableau::kDenseDegree>& q, std::index_sequence<kPower...>) const {
    ((q[kPower] = dense_coefficient<kPower>()), ...);
  }
  template <std::size_t kPower>
  [[nodiscard]] State dense_coefficient() const {
    State sum = (step * Tableau::p[0][kPower]) * k[0];
    for (int i = 1; i < kStages; ++i) {
      if (Tableau::p[i][kPower] != 0.0) sum += (step * Tableau::p[i][kPower]) * k[i];
    }
    return sum;
  }
};

/// x + sum_j q_j theta^(j+1).
template <class State, std::size_t kDegree>
[[nodiscard]] State dense_value(const State& x, const std::array<State, kDegree>& q, double theta) {
  State sum = theta * q[kDegree - 1];
  for (std::size_t j = kDegree - 1; j-- > 0;) sum = theta * (q[j] + sum);
  return x + sum;
}

}  // namespace palpate
