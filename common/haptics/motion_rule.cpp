#include "common/haptics/motion_rule.h"

#include <algorithm>
#include <cmath>

namespace palpate {

double drag(double dx, double tau) noexcept { return std::copysign(std::max(std::abs(dx) - tau, 0.0), dx); }

double unilateral(double dx_outward, double tau) noexcept {
  return dx_outward > 0.0 ? dx_outward : std::min(dx_outward + tau, 0.0);
}

double snap_drag(double dx, double tau) noexcept {
  if (!(tau > 0.0)) return dx;
  const double away = std::abs(dx) / tau;
  if (!(away > 1.0)) return 0.0;
  constexpr double kCountable = 0x1p52;  // beyond this teeth cannot be told apart: the probe itself will do
  if (!(away < kCountable)) return dx;
  return std::copysign(tau * (std::ceil(away) - 1.0), dx);
}

Vec3 drag_jointly(const Vec3& dx, const Vec3& tau) noexcept {
  // What is left between probe and proxy, r_a = dx_a tau_a^2 / (tau_a^2 + m), lies on the ellipsoid for
  // exactly one multiplier m >= 0, since each |r_a| falls with m (Hart 1994, distance to an ellipsoid).
  const double largest = std::max({std::abs(dx.x), std::abs(dx.y), std::abs(dx.z)});
  if (!(largest > 0.0)) return Vec3{0.0};
  const auto left_at = [&](double m) {
    Vec3 left{0.0};
    for (int a = 0; a < 3; ++a) {
      const double t = tau[a] / largest, t2 = t * t;
      left[a] = t2 < HUGE_VAL ? (t2 > 0.0 ? dx[a] * (t2 / (t2 + m)) : 0.0) : dx[a];
    }
    return left;
  };
  const auto excess = [&](double m) {
    double sum = 0.0;
    for (int a = 0; a < 3; ++a) {
      const double t = tau[a] / largest, t2 = t * t;
      if (!(t2 > 0.0) || !(t2 < HUGE_VAL)) continue;  // free, or fixed
      const double part = (dx[a] / largest) * t / (t2 + m);
      sum += part * part;
    }
    return sum - 1.0;
  };
  const Vec3 at_rest = left_at(0.0);
  // What an earlier drag left on the ellipsoid, to rounding, lies in it: a second one moves nothing.
  constexpr double kRounding = 0x1p-40;
  if (excess(0.0) <= kRounding) return dx - at_rest;
  // excess(m) < 0 at m = |dx tau| summed: bisection on a bracket that halves each time, so its bound is
  // fixed; Newton's steps, taken where they stay inside, make it short.
  double low = 0.0, high = 0.0;
  for (int a = 0; a < 3; ++a) {
    const double t = tau[a] / largest;
    if (t < HUGE_VAL) high += std::abs(dx[a] / largest) * t;
  }
  double m = 0.0;
  constexpr int kMaxSteps = 60;
  for (int n = 0; n < kMaxSteps; ++n) {
    const double f = excess(m);
    (f > 0.0 ? low : high) = m;
    double slope = 0.0;
    for (int a = 0; a < 3; ++a) {
      const double t = tau[a] / largest, t2 = t * t;
      if (!(t2 > 0.0) || !(t2 < HUGE_VAL)) continue;
      const double part = (dx[a] / largest) * t / (t2 + m);
      slope -= 2.0 * part * part / (t2 + m);
    }
    // Newton on 1 - 1/sqrt(sum), which is nearly straight.
    const double root = std::sqrt(f + 1.0);
    const double next = m - 2.0 * (f + 1.0) * (root - 1.0) / slope;
    const double guess = next > low && next < high ? next : 0.5 * (low + high);
    if (std::abs(guess - m) <= 1e-15 * guess) break;
    m = guess;
  }
  return dx - left_at(m);
}

}  // namespace palpate
