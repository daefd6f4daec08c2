#include "common/haptics/motion_rule.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

/// What an earlier motion left at a threshold, to rounding, is within it: a second one moves nothing.
constexpr double kRounding = 0x1p-40;

/// Beyond this many, teeth cannot be told apart: the probe itself will do.
constexpr double kCountable = 0x1p52;

/// Whole teeth by which a proxy goes after a probe that is `away` teeth from it, to come within one.
double teeth_passed(double away) noexcept { return std::max(std::ceil(away - kRounding) - 1.0, 0.0); }

/// What joint drag leaves between probe and proxy, r_a = dx_a tau_a^2 / (tau_a^2 + m), lies on the ellipsoid
/// for exactly one multiplier m >= 0, since each |r_a| falls with m (Hart 1994, distance to an ellipsoid).
class Ellipsoid {
 public:
  Ellipsoid(const Vec3& dx, const Vec3& tau) noexcept : dx_(dx) {
    const double largest = std::max({std::abs(dx.x), std::abs(dx.y), std::abs(dx.z)});
    const double scale = largest > 0.0 ? largest : 1.0;
    y_ = dx / scale;
    t_ = tau / scale;
    m_ = multiplier();
  }

  /// r.
  [[nodiscard]] Vec3 left() const noexcept {
    Vec3 r{0.0};
    for (int a = 0; a < 3; ++a) r[a] = dx_[a] * part(a);
    return r;
  }

  [[nodiscard]] Mat3 jacobian() const noexcept {
    Vec3 v{0.0}, diagonal{0.0};
    double sum = 0.0;
    for (int a = 0; a < 3; ++a) {
      diagonal[a] = 1.0 - part(a);
      if (m_ == 0.0 || !counts(a)) continue;
      const double t2 = t_[a] * t_[a], level = y_[a] * t_[a] / (t2 + m_);
      v[a] = level * t_[a] / (t2 + m_);
      sum += level * level / (t2 + m_);
    }
    const Mat3 outer = sum > 0.0 ? glm::outerProduct(v / sum, v) : Mat3{0.0};
    return outer + Mat3{diagonal.x, 0.0, 0.0, 0.0, diagonal.y, 0.0, 0.0, 0.0, diagonal.z};
  }

 private:
  /// Neither free nor fixed.
  [[nodiscard]] bool counts(int a) const noexcept {
    const double t2 = t_[a] * t_[a];
    return t2 > 0.0 && t2 < HUGE_VAL;
  }

  /// r_a / dx_a.
  [[nodiscard]] double part(int a) const noexcept {
    const double t2 = t_[a] * t_[a];
    if (!(t2 > 0.0)) return 0.0;
    return t2 < HUGE_VAL ? t2 / (t2 + m_) : 1.0;
  }

  /// How far r for the multiplier `m` is outside, and its slope.
  [[nodiscard]] double excess(double m, double& slope) const noexcept {
    double sum = 0.0;
    slope = 0.0;
    for (int a = 0; a < 3; ++a) {
      if (!counts(a)) continue;
      const double t2 = t_[a] * t_[a], level = y_[a] * t_[a] / (t2 + m);
      sum += level * level;
      slope -= 2.0 * level * level / (t2 + m);
    }
    return sum - 1.0;
  }

  [[nodiscard]] double multiplier() const noexcept {
    double slope = 0.0, f = excess(0.0, slope);
    if (f <= kRounding) return 0.0;
    // excess(m) < 0 at m = |dx tau| summed: bisection on a bracket that halves each time, so its bound is
    // fixed; Newton's steps, taken where they stay inside, make it short.
    double low = 0.0, high = 0.0;
    for (int a = 0; a < 3; ++a) {
      if (t_[a] < HUGE_VAL) high += std::abs(y_[a]) * t_[a];
    }
    double m = 0.0;
    constexpr int kMaxSteps = 60;
    for (int n = 0; n < kMaxSteps; ++n) {
      (f > 0.0 ? low : high) = m;
      // Newton on 1 - 1/sqrt(sum), which is nearly straight.
      const double root = std::sqrt(f + 1.0);
      const double next = m - 2.0 * (f + 1.0) * (root - 1.0) / slope;
      const double guess = next > low && next < high ? next : 0.5 * (low + high);
      if (std::abs(guess - m) <= 1e-15 * guess) break;
      m = guess;
      f = excess(m, slope);
    }
    return m;
  }

  Vec3 dx_;
  Vec3 y_{0.0}, t_{0.0};  ///< dx and tau over the largest component of dx, and m over its square
  double m_ = 0.0;
};

}  // namespace

double drag(double dx, double tau) noexcept { return std::copysign(std::max(std::abs(dx) - tau, 0.0), dx); }

double unilateral(double dx_outward, double tau) noexcept {
  return dx_outward > 0.0 ? dx_outward : std::min(dx_outward + tau, 0.0);
}

double snap_drag(double dx, double tau) noexcept {
  if (!(tau > 0.0)) return dx;
  const double away = std::abs(dx) / tau;
  return away < kCountable ? std::copysign(tau * teeth_passed(away), dx) : dx;
}

Vec3 drag_jointly(const Vec3& dx, const Vec3& tau) noexcept { return dx - Ellipsoid(dx, tau).left(); }

Mat3 drag_jacobian(const Vec3& dx, const Vec3& tau) noexcept { return Ellipsoid(dx, tau).jacobian(); }

Vec3 snap_jointly(const Vec3& dx, const Vec3& tau) noexcept {
  double squared = 0.0;
  for (int a = 0; a < 3; ++a) {
    const double part = dx[a] / tau[a];
    if (tau[a] > 0.0) squared += part * part;
  }
  const double away = std::sqrt(squared);
  double part = away > 0.0 ? teeth_passed(away) / away : 0.0;
  if (!(away < kCountable)) part = 1.0;
  Vec3 moved{0.0};
  for (int a = 0; a < 3; ++a) {
    if (!(tau[a] > 0.0)) moved[a] = dx[a];
    if (tau[a] > 0.0 && tau[a] < HUGE_VAL) moved[a] = part * dx[a];
  }
  return moved;
}

}  // namespace palpate
