/// Numbers of twice the digits of a double: an unevaluated sum of two, some 2^-104 exact.
///
/// Dekker 1971; Hida, Li and Bailey 2001 (the accurate sum). No fused multiply-add is used: that of a processor without it is
/// slower than Dekker's products.
#pragma once

#include <cmath>

namespace palpate {

class DoubleDouble {
 public:
  constexpr DoubleDouble() = default;
  constexpr DoubleDouble(double value)
      : high_(value) {}  // NOLINT(google-explicit-constructor): a number is a number

  [[nodiscard]] constexpr double high() const noexcept { return high_; }
  [[nodiscard]] explicit constexpr operator double() const noexcept { return high_ + low_; }

  constexpr DoubleDouble operator-() const noexcept { return {-high_, -low_}; }
  friend constexpr DoubleDouble operator+(const DoubleDouble& x, const DoubleDouble& y) noexcept {
    const DoubleDouble s = sum(x.high_, y.high_), t = sum(x.low_, y.low_);
    const DoubleDouble u = quick_sum(s.high_, s.low_ + t.high_);
    return quick_sum(u.high_, u.low_ + t.low_);
  }
  friend constexpr DoubleDouble operator-(const DoubleDouble& x, const DoubleDouble& y) noexcept {
    return x + -y;
  }
  friend constexpr DoubleDouble operator*(const DoubleDouble& x, const DoubleDouble& y) noexcept {
    const DoubleDouble p = product(x.high_, y.high_);
    return quick_sum(p.high_, p.low_ + (x.high_ * y.low_ + x.low_ * y.high_));
  }
  friend constexpr DoubleDouble operator/(const DoubleDouble& x, const DoubleDouble& y) noexcept {
    const double first = x.high_ / y.high_;
    const DoubleDouble rest = x - y * first;
    const double second = rest.high_ / y.high_;
    const double third = (rest - y * second).high_ / y.high_;
    return quick_sum(first, second) + third;
  }
  constexpr DoubleDouble& operator+=(const DoubleDouble& y) noexcept { return *this = *this + y; }
  constexpr DoubleDouble& operator-=(const DoubleDouble& y) noexcept { return *this = *this - y; }
  constexpr DoubleDouble& operator*=(const DoubleDouble& y) noexcept { return *this = *this * y; }
  constexpr DoubleDouble& operator/=(const DoubleDouble& y) noexcept { return *this = *this / y; }

  friend constexpr bool operator==(const DoubleDouble& x, const DoubleDouble& y) noexcept = default;
  friend constexpr auto operator<=>(const DoubleDouble& x, const DoubleDouble& y) noexcept = default;

  friend constexpr DoubleDouble abs(const DoubleDouble& x) noexcept { return x.high_ < 0.0 ? -x : x; }
  friend DoubleDouble sqrt(const DoubleDouble& x) noexcept {
    if (!(x.high_ > 0.0)) return std::sqrt(x.high_);
    const double root = std::sqrt(x.high_);
    return quick_sum(root, (x - product(root, root)).high_ / (2.0 * root));
  }

 private:
  constexpr DoubleDouble(double high, double low) : high_(high), low_(low) {}

  /// x + y, without loss.
  static constexpr DoubleDouble sum(double x, double y) noexcept {
    const double s = x + y, part = s - x;
    return {s, (x - (s - part)) + (y - part)};
  }
  /// The same where |x| >= |y|.
  static constexpr DoubleDouble quick_sum(double x, double y) noexcept {
    const double s = x + y;
    return {s, y - (s - x)};
  }
  /// x y, without loss. @pre |x|, |y| < 2^996.
  static constexpr DoubleDouble product(double x, double y) noexcept {
    constexpr double kSplit = 0x1p27 + 1.0;
    const double sx = kSplit * x, sy = kSplit * y;
    const double x1 = sx - (sx - x), y1 = sy - (sy - y), x2 = x - x1, y2 = y - y1, p = x * y;
    return {p, ((x1 * y1 - p) + x1 * y2 + x2 * y1) + x2 * y2};
  }

  double high_ = 0.0, low_ = 0.0;
};

}  // namespace palpate
