/// Four doubles as two SSE registers: barycentric coordinates, or a position with its time. A type of two
/// halves because a 32-byte vector type would change the calling convention on baseline x86-64.
#pragma once

#include <cmath>

#include "common/math/vec.h"

namespace palpate {

using Pack2 = double __attribute__((vector_size(16)));

struct Pack4 {
  Pack2 lo{0.0, 0.0};
  Pack2 hi{0.0, 0.0};

  Pack4() = default;
  Pack4(Pack2 low, Pack2 high) : lo(low), hi(high) {}
  Pack4(double a, double b, double c, double d) : lo{a, b}, hi{c, d} {}
  Pack4(const Vec3& x, double w) : lo{x.x, x.y}, hi{x.z, w} {}
  [[nodiscard]] static Pack4 all(double a) { return {a, a, a, a}; }

  [[nodiscard]] double operator[](int i) const { return i < 2 ? lo[i] : hi[i - 2]; }
  void set(int i, double value) {
    if (i < 2) {
      lo[i] = value;
    } else {
      hi[i - 2] = value;
    }
  }
  [[nodiscard]] Vec3 xyz() const { return {lo[0], lo[1], hi[0]}; }

  Pack4& operator+=(const Pack4& y) {
    lo += y.lo;
    hi += y.hi;
    return *this;
  }
};

inline Pack4 operator+(const Pack4& x, const Pack4& y) { return {x.lo + y.lo, x.hi + y.hi}; }
inline Pack4 operator-(const Pack4& x, const Pack4& y) { return {x.lo - y.lo, x.hi - y.hi}; }
inline Pack4 operator*(const Pack4& x, const Pack4& y) { return {x.lo * y.lo, x.hi * y.hi}; }
inline Pack4 operator*(double a, const Pack4& x) {
  const Pack2 aa{a, a};
  return {aa * x.lo, aa * x.hi};
}

[[nodiscard]] inline double max_abs(const Pack4& x) {
  const auto larger = [](double a, double b) { return a > b ? a : b; };
  return larger(larger(std::abs(x.lo[0]), std::abs(x.lo[1])), larger(std::abs(x.hi[0]), std::abs(x.hi[1])));
}
[[nodiscard]] inline double min_lane(const Pack4& x) {
  const auto smaller = [](double a, double b) { return a < b ? a : b; };
  return smaller(smaller(x.lo[0], x.lo[1]), smaller(x.hi[0], x.hi[1]));
}

}  // namespace palpate
