/// Dual numbers of three variables: a value with its gradient, carried along by the chain rule. A formula
/// written once as a template then has derivatives that are exact to rounding.
#pragma once

#include <cmath>

#include "common/math/vec.h"

namespace palpate {

struct Dual3 {
  double value = 0.0;
  Vec3 gradient{0.0};

  Dual3() = default;
  Dual3(double constant) noexcept : value(constant) {}  // NOLINT: constants mix with variables
  Dual3(double v, const Vec3& g) noexcept : value(v), gradient(g) {}
};

inline Dual3 operator-(const Dual3& a) noexcept { return {-a.value, -a.gradient}; }
inline Dual3 operator+(const Dual3& a, const Dual3& b) noexcept {
  return {a.value + b.value, a.gradient + b.gradient};
}
inline Dual3 operator-(const Dual3& a, const Dual3& b) noexcept {
  return {a.value - b.value, a.gradient - b.gradient};
}
inline Dual3 operator*(const Dual3& a, const Dual3& b) noexcept {
  return {a.value * b.value, a.gradient * b.value + b.gradient * a.value};
}
inline Dual3 operator/(const Dual3& a, const Dual3& b) noexcept {
  const double quotient = a.value / b.value;
  return {quotient, (a.gradient - b.gradient * quotient) / b.value};
}
inline bool operator<(const Dual3& a, const Dual3& b) noexcept { return a.value < b.value; }

inline Dual3 sin(const Dual3& a) noexcept { return {std::sin(a.value), a.gradient * std::cos(a.value)}; }
inline Dual3 cos(const Dual3& a) noexcept { return {std::cos(a.value), a.gradient * -std::sin(a.value)}; }
inline Dual3 exp(const Dual3& a) noexcept {
  const double e = std::exp(a.value);
  return {e, a.gradient * e};
}
/// @pre a > 0.
inline Dual3 sqrt(const Dual3& a) noexcept {
  const double root = std::sqrt(a.value);
  return {root, a.gradient * (0.5 / root)};
}

}  // namespace palpate
