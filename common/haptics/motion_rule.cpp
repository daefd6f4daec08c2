#include "common/haptics/motion_rule.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

/// What an earlier motion left at a threshold, to rounding, is within it: a second one moves nothing.
constexpr double kRounding = 0x1p-40;

/// Beyond this many, detents cannot be told apart: the probe itself will do.
constexpr double kCountable = 0x1p52;

/// Whole detents by which a proxy goes after a probe that is `away` detents from it, to come within one.
double detents_passed(double away) noexcept { return std::max(std::ceil(away - kRounding) - 1.0, 0.0); }

/// What joint drag leaves between probe and proxy, r_a = dx_a tau_a^2 / (tau_a^2 + m), lies on the ellipsoid
/// for exactly one multiplier m >= 0, since each |r_a| falls with m (Hart 1994, distance to an ellipsoid).
/// 1/|r/tau| rises with m and is concave (Conn, Gould and Toint 2000, lemma 7.3.1), nearly straight where one
/// axis counts more than the others: Newton's method on it comes to the root from below, in a few steps.
class Ellipsoid {
 public:
  Ellipsoid(const Vec3& dx, const Vec3& tau) noexcept : dx_(dx) {
    const double largest = std::max({std::abs(dx.x), std::abs(dx.y), std::abs(dx.z)});
    const double scale = largest > 0.0 ? largest : 1.0;
    y_ = dx / scale;
    t_ = tau / scale;
    solve();
  }

  [[nodiscard]] int newton_steps() const noexcept { return steps_; }

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
  /// A threshold whose square is below this, of a displacement of 1, is none: all squares below stay finite.
  static constexpr double kNoThreshold = 0x1p-1000;

  /// Neither free nor fixed.
  [[nodiscard]] bool counts(int a) const noexcept {
    const double t2 = t_[a] * t_[a];
    return t2 > kNoThreshold && t2 < HUGE_VAL;
  }

  /// r_a / dx_a.
  [[nodiscard]] double part(int a) const noexcept {
    const double t2 = t_[a] * t_[a];
    if (!(t2 > kNoThreshold)) return 0.0;
    return t2 < HUGE_VAL ? t2 / (t2 + m_) : 1.0;
  }

  /// How far r for the multiplier `m` is outside: |r/tau| - 1, and how fast its logarithm falls with m.
  [[nodiscard]] double excess(double m, double& fall) const noexcept {
    Vec3 squares{0.0}, over{1.0};
    for (int a = 0; a < 3; ++a) {
      if (!counts(a)) continue;
      over[a] = t_[a] * t_[a] + m;
      const double level = y_[a] * t_[a] / over[a];
      squares[a] = level * level;
    }
    const double sum = squares.x + squares.y + squares.z;
    fall = 0.0;
    for (int a = 0; a < 3; ++a) fall += squares[a] / sum / over[a];
    return std::sqrt(sum) - 1.0;
  }

  void solve() noexcept {
    double fall = 0.0, outside = excess(0.0, fall);
    if (outside <= kRounding) return;
    // What is left of it at the root is its own rounding, whatever m: a test of how far m still moves would
    // never be met where m is small beside tau^2.
    constexpr double kAtRoot = 0x1p-51;
    while (outside > kAtRoot && steps_ < kMaxNewtonSteps) {
      m_ += outside / fall;
      outside = excess(m_, fall);
      ++steps_;
    }
  }

  Vec3 dx_;
  Vec3 y_{0.0}, t_{0.0};  ///< dx and tau over the largest component of dx, and m over its square
  double m_ = 0.0;
  int steps_ = 0;
};

}  // namespace

double drag(double dx, double tau) noexcept { return std::copysign(std::max(std::abs(dx) - tau, 0.0), dx); }

double unilateral(double dx_outward, double tau) noexcept {
  return dx_outward > 0.0 ? dx_outward : std::min(dx_outward + tau, 0.0);
}

double snap_drag(double dx, double tau) noexcept {
  if (!(tau > 0.0)) return dx;
  const double away = std::abs(dx) / tau;
  return away < kCountable ? std::copysign(tau * detents_passed(away), dx) : dx;
}

JointDrag drag_jointly(const Vec3& dx, const Vec3& tau) noexcept {
  const Ellipsoid ellipsoid(dx, tau);
  return {dx - ellipsoid.left(), ellipsoid.jacobian(), ellipsoid.newton_steps()};
}

Vec3 snap_jointly(const Vec3& dx, const Vec3& tau) noexcept {
  double squared = 0.0;
  for (int a = 0; a < 3; ++a) {
    const double part = dx[a] / tau[a];
    if (tau[a] > 0.0) squared += part * part;
  }
  const double away = std::sqrt(squared);
  double part = away > 0.0 ? detents_passed(away) / away : 0.0;
  if (!(away < kCountable)) part = 1.0;
  Vec3 moved{0.0};
  for (int a = 0; a < 3; ++a) {
    if (!(tau[a] > 0.0)) moved[a] = dx[a];
    if (tau[a] > 0.0 && tau[a] < HUGE_VAL) moved[a] = part * dx[a];
  }
  return moved;
}

}  // namespace palpate
