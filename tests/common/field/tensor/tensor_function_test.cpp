#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/field/tensor/eigenframe.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }

/// A positive tensor as B B^T.
Mat3 random_tensor(std::mt19937_64& random) {
  Mat3 b{0.0};
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) b[c][r] = 2.0 * unit(random) - 1.0;
  }
  return b * glm::transpose(b) + 0.05 * Mat3{1.0};
}

double largest_difference(const Mat3& a, const Mat3& b) {
  double most = 0.0;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) most = std::max(most, std::abs(a[c][r] - b[c][r]));
  }
  return most;
}

/// exp by its series, of a matrix that was halved until that converges at once.
Mat3 exp_by_series(Mat3 a) {
  constexpr int kHalvings = 12;
  a /= 0x1p12;
  Mat3 term{1.0}, sum{1.0};
  for (int n = 1; n < 12; ++n) {
    term = term * a / static_cast<double>(n);
    sum += term;
  }
  for (int i = 0; i < kHalvings; ++i) sum = sum * sum;
  return sum;
}

TEST(TensorFunction, ExponentialIsThatOfTheSeriesAndUndoesTheLogarithm) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 200; ++i) {
    const Mat3 d = random_tensor(random);
    EXPECT_LT(largest_difference(symmetric_exp(d), exp_by_series(d)), 1e-9);
    EXPECT_LT(largest_difference(symmetric_exp(symmetric_log(d, 1e-9)), d), 1e-13);
  }
}

TEST(TensorFunction, EigenvaluesBelowTheFloorAreLiftedToIt) {
  const Mat3 d{Vec3{1, 0, 0}, Vec3{0, 1e-9, 0}, Vec3{0, 0, -0.1}};
  const Vec3 values = symmetric_eigenvalues(symmetric_exp(symmetric_log(d, 1e-6)));
  EXPECT_NEAR(values[0], 1.0, 1e-15);
  EXPECT_NEAR(values[1], 1e-6, 1e-20);
  EXPECT_NEAR(values[2], 1e-6, 1e-20);
}

}  // namespace
}  // namespace palpate
