/// A second look at the error of steps, two at a time.
///
///   x_2 - x_0 = (a + b)/6 ((2 - b/a) k_0 + (a + b)^2/(a b) k_1 + (2 - a/b) k_2) + d                (1)
///
/// a, b the lengths of two steps in a row from x_0 over x_1 to x_2, k_i the slopes there: Simpson's rule, the integral of the
/// parabola through three slopes; d is O(h^5) for steps alike, else O(h^4), as the errors of methods of order four and three
/// are (Hairer, Norsett, Wanner 1993, III.1: Milne-Simpson). It vanishes elsewhere than a method's own estimate does, which next to
/// a slow manifold is where the controller settles: that of bs32 is -z^3 (1 + z)/48, nothing at z = h lambda = -1.
#pragma once

#include <cmath>

#include "common/math/pack4.h"

namespace palpate {

class TwoSteps {
 public:
  /// Where the flow is not smooth on the way from one step to the next.
  void restart() noexcept { length_ = 0.0; }

  /// Adds the step of `length` from y with slope k. @return |d| of the position; 0 where no step of a similar length went
  /// before.
  [[nodiscard]] double add(const Pack4& y, const Pack4& k, const Pack4& y_end, const Pack4& k_end,
                           double length) noexcept {
    constexpr double kAlike = 3.0;  // beyond it the weights of (1) grow
    const double a = length_, b = length;
    double off = 0.0;
    if (a < kAlike * b && b < kAlike * a) {
      const double both = a + b;
      const Pack4 d =
          y_end - start_ -
          (both / 6.0) * ((2.0 - b / a) * slope_ + (both * both / (a * b)) * k + (2.0 - a / b) * k_end);
      off = std::sqrt(dot3(d, d));
    }
    start_ = y;
    slope_ = k;
    length_ = length;
    return off;
  }

 private:
  Pack4 start_, slope_;  ///< of the last step
  double length_ = 0.0;  ///< 0: none
};

}  // namespace palpate
