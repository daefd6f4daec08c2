/// Second-order jets of three variables: a value with its gradient and Hessian, carried along by the chain
/// rule. A formula written once as a template then has first and second derivatives exact to rounding.
///
/// With g = grad a and H = Hessian of a, a function f of a has the gradient f' g and the Hessian
/// f' H + f'' g g^T.
#pragma once

#include <cmath>

#include "common/math/vec.h"

namespace palpate {

struct Jet3 {
  double value = 0.0;
  Vec3 gradient{0.0};
  Mat3 hessian{0.0};  ///< symmetric

  Jet3() = default;
  Jet3(double constant) noexcept : value(constant) {}  // NOLINT: constants mix with variables
  Jet3(double v, const Vec3& g, const Mat3& h = Mat3{0.0}) noexcept : value(v), gradient(g), hessian(h) {}

  /// The coordinate `axis` at `x`.
  [[nodiscard]] static Jet3 variable(const Vec3& x, int axis) noexcept {
    Jet3 out(x[axis]);
    out.gradient[axis] = 1.0;
    return out;
  }
};

namespace detail {

/// f(a), of which f, f' and f'' at a.value are given.
[[nodiscard]] inline Jet3 chain(const Jet3& a, double f, double first, double second) noexcept {
  return {f, first * a.gradient, first * a.hessian + second * glm::outerProduct(a.gradient, a.gradient)};
}

}  // namespace detail

inline Jet3 operator-(const Jet3& a) noexcept { return {-a.value, -a.gradient, -a.hessian}; }
inline Jet3 operator+(const Jet3& a, const Jet3& b) noexcept {
  return {a.value + b.value, a.gradient + b.gradient, a.hessian + b.hessian};
}
inline Jet3 operator-(const Jet3& a, const Jet3& b) noexcept {
  return {a.value - b.value, a.gradient - b.gradient, a.hessian - b.hessian};
}
inline Jet3 operator*(const Jet3& a, const Jet3& b) noexcept {
  const Mat3 mixed = glm::outerProduct(a.gradient, b.gradient);
  return {a.value * b.value, a.gradient * b.value + b.gradient * a.value,
          a.hessian * b.value + b.hessian * a.value + (mixed + glm::transpose(mixed))};
}
inline Jet3 operator/(const Jet3& a, const Jet3& b) noexcept {
  const double inverse = 1.0 / b.value;
  Jet3 out = a * detail::chain(b, inverse, -inverse * inverse, 2.0 * inverse * inverse * inverse);
  out.value = a.value / b.value;  // the bits that plain numbers give
  return out;
}

inline Jet3 sin(const Jet3& a) noexcept {
  const double s = std::sin(a.value);
  return detail::chain(a, s, std::cos(a.value), -s);
}
inline Jet3 cos(const Jet3& a) noexcept {
  const double c = std::cos(a.value);
  return detail::chain(a, c, -std::sin(a.value), -c);
}
inline Jet3 exp(const Jet3& a) noexcept {
  const double e = std::exp(a.value);
  return detail::chain(a, e, e, e);
}
/// @pre a > 0.
inline Jet3 sqrt(const Jet3& a) noexcept {
  const double root = std::sqrt(a.value);
  return detail::chain(a, root, 0.5 / root, -0.25 / (root * a.value));
}

}  // namespace palpate
