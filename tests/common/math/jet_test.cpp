#include "common/math/jet.h"

#include <gtest/gtest.h>

#include "common/math/dual.h"

namespace palpate {
namespace {

using std::cos;
using std::exp;
using std::sin;
using std::sqrt;

template <typename T>
T formula(const T& x, const T& y, const T& z) {
  return (sin(x * y) - T(2.0) * exp(z)) / sqrt(T(1.0) + x * x) + cos(y - z) * -x;
}

Dual3 first_order(const Vec3& at) {
  return formula(Dual3(at.x, {1, 0, 0}), Dual3(at.y, {0, 1, 0}), Dual3(at.z, {0, 0, 1}));
}

TEST(Jet3, CarriesValueGradientAndHessianOfAFormula) {
  const Vec3 at{0.7, -1.3, 0.4};
  const Jet3 jet = formula(Jet3::variable(at, 0), Jet3::variable(at, 1), Jet3::variable(at, 2));
  EXPECT_DOUBLE_EQ(jet.value, formula(at.x, at.y, at.z));
  EXPECT_LT(glm::distance(jet.gradient, first_order(at).gradient), 1e-15);
  // The Hessian from central differences of exact gradients: errors h^2 / 6 times fourth derivatives.
  constexpr double kStep = 1e-4;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 ahead = at, behind = at;
    ahead[axis] += kStep;
    behind[axis] -= kStep;
    const Vec3 slope = (first_order(ahead).gradient - first_order(behind).gradient) / (2.0 * kStep);
    EXPECT_LT(glm::distance(jet.hessian[axis], slope), 1e-7);
  }
  EXPECT_EQ(jet.hessian, glm::transpose(jet.hessian));
}

}  // namespace
}  // namespace palpate
