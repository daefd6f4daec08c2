/// The flow of x' = J x + v, from x = 0 at time 0:
///
///   x(t) = reach(t) v,   x'(t) = growth(t) v,   growth(t) = e^(tJ),   reach(t) = int_0^t e^(sJ) ds      (1)
///
/// by the implicit midpoint rule in 2^k equal steps, doubled k times. Its growth over a step is the (1,1) Pade
/// approximant of the exponential, so that whatever J is it grows, decays and rests where the flow does; fixed
/// points are exact (Hairer and Wanner 1996, IV.3; doubling: Moler and Van Loan 2003, method 3).
#pragma once

#include <algorithm>
#include <cmath>

#include "common/math/vec.h"

namespace palpate {

struct LinearStep {
  Mat3 growth{1.0};
  Mat3 reach{0.0};

  /// One step. @pre |h| row_sum(j) < 2: below that the rule has no pole.
  LinearStep(const Mat3& j, double h) {
    const Mat3 half = (0.5 * h) * j;
    const Mat3 inverse = glm::inverse(Mat3{1.0} - half);
    growth = inverse * (Mat3{1.0} + half);
    reach = h * inverse;
  }

  /// Twice as long.
  void repeat() {
    reach += growth * reach;
    growth = growth * growth;
  }

  /// Bound of the rates of J: its norm by rows.
  [[nodiscard]] static double row_sum(const Mat3& j) {
    const auto row = [&](int i) { return std::abs(j[0][i]) + std::abs(j[1][i]) + std::abs(j[2][i]); };
    return std::max(row(0), std::max(row(1), row(2)));
  }
};

/// e^(hJ), the growth over any length `h`; NaN where that overflows.
[[nodiscard]] inline Mat3 linear_growth(const Mat3& j, double h) {
  int doublings = 0;
  (void)std::frexp(std::abs(h) * LinearStep::row_sum(j), &doublings);
  doublings = std::max(doublings, 0);
  LinearStep step(j, std::ldexp(h, -doublings));
  for (int i = 0; i < doublings; ++i) step.repeat();
  return step.growth;
}

}  // namespace palpate
