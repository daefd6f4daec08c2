#include "common/math/dual.h"

#include <gtest/gtest.h>

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

TEST(Dual3, CarriesTheGradientOfAFormula) {
  const Vec3 at{0.7, -1.3, 0.4};
  const Dual3 value = formula(Dual3(at.x, {1, 0, 0}), Dual3(at.y, {0, 1, 0}), Dual3(at.z, {0, 0, 1}));
  EXPECT_EQ(value.value, formula(at.x, at.y, at.z));
  // By hand, with r = sqrt(1 + x^2) and n = sin(x y) - 2 e^z.
  const double r = std::sqrt(1.0 + at.x * at.x);
  const double n = std::sin(at.x * at.y) - 2.0 * std::exp(at.z);
  const Vec3 expected{at.y * std::cos(at.x * at.y) / r - n * at.x / (r * r * r) - std::cos(at.y - at.z),
                      at.x * std::cos(at.x * at.y) / r + std::sin(at.y - at.z) * at.x,
                      -2.0 * std::exp(at.z) / r - std::sin(at.y - at.z) * at.x};
  EXPECT_LT(glm::distance(value.gradient, expected), 1e-15);
}

}  // namespace
}  // namespace palpate
