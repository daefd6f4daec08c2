/// The root of a continuous function in a bracket, for events along a dense output.
#pragma once

#include <algorithm>
#include <cmath>

namespace palpate {

/// A point of [low, high] where `f` changes sign, to `tolerance` in the argument: the Illinois variant of
/// the secant rule (Dowell and Jarratt 1971), with bisection wherever it fails to halve the bracket in
/// three evaluations. Returns the end of the final bracket on the side of f(high), so that an event is
/// never reported before it happened.
/// @pre f(low) and f(high) differ in sign (zero counts as the sign of `high`).
template <class Function>
[[nodiscard]] double bracketed_root(const Function& f, double low, double high, double f_low, double f_high,
                                    double tolerance) {
  constexpr int kMaxEvaluations = 200;  // bisection alone needs 60 for a double
  double checkpoint = high - low;
  int since_checkpoint = 0;
  int kept = 0;  // the end that the last evaluation left in place: -1 low, +1 high
  for (int n = 0; n < kMaxEvaluations && high - low > tolerance && f_high != 0.0; ++n) {
    double x = low + (high - low) * (f_low / (f_low - f_high));
    if (++since_checkpoint > 3) {
      if (high - low > 0.5 * checkpoint) x = 0.5 * (low + high);
      checkpoint = high - low;
      since_checkpoint = 0;
    }
    // Stay half a tolerance inside, so that the bracket closes from both sides.
    x = std::clamp(x, low + 0.5 * tolerance, high - 0.5 * tolerance);
    if (!(x > low && x < high)) break;
    const double fx = f(x);
    if (fx != 0.0 && std::signbit(fx) == std::signbit(f_low)) {
      low = x;
      f_low = fx;
      if (kept == 1) f_high *= 0.5;
      kept = 1;
    } else {
      high = x;
      f_high = fx;
      if (kept == -1) f_low *= 0.5;
      kept = -1;
    }
  }
  return high;
}

}  // namespace palpate
