#include "common/field/tensor/tensor_mean.h"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

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

TEST(TensorMean, ExponentialIsThatOfTheSeriesAndUndoesTheLogarithm) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 200; ++i) {
    const Mat3 d = random_tensor(random);
    EXPECT_LT(largest_difference(symmetric_exp(d), exp_by_series(d)), 1e-9);
    EXPECT_LT(largest_difference(symmetric_exp(symmetric_log(d)), d), 1e-13);
  }
}

TEST(TensorMean, LogEuclideanDeterminantIsTheGeometricMean) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 200; ++i) {
    const std::array tensors{random_tensor(random), random_tensor(random), random_tensor(random)};
    const std::array weights{0.2, 0.5, 0.3};
    const Mat3 mean = tensor_mean(tensors, weights, TensorInterpolation::kLogEuclidean);
    double expected = 1.0;
    for (std::size_t k = 0; k < 3; ++k) {
      expected *= std::pow(glm::determinant(tensors[k]), weights[k]);
    }
    EXPECT_NEAR(glm::determinant(mean), expected, 1e-12);
  }
}

TEST(TensorMean, ATensorAndItsInverseMeetInTheUnit) {
  std::mt19937_64 random(3);
  const Mat3 d = random_tensor(random);
  const std::array pair{d, glm::inverse(d)};
  const std::array weights{0.5, 0.5};
  EXPECT_LT(largest_difference(tensor_mean(pair, weights, TensorInterpolation::kLogEuclidean), Mat3{1.0}),
            1e-12);
}

TEST(TensorMean, ComponentsAreMeansOfComponents) {
  std::mt19937_64 random(4);
  const std::array pair{random_tensor(random), random_tensor(random)};
  const std::array weights{0.25, 0.75};
  EXPECT_LT(largest_difference(tensor_mean(pair, weights, TensorInterpolation::kComponents),
                               0.25 * pair[0] + 0.75 * pair[1]),
            1e-15);
}

TEST(TensorMean, WithoutALogarithmTheComponentsAreTaken) {
  const std::array pair{Mat3{0.0}, Mat3{2.0}};
  const std::array weights{0.5, 0.5}, one{0.0, 1.0};
  EXPECT_EQ(tensor_mean(pair, weights, TensorInterpolation::kLogEuclidean), Mat3{1.0});
  EXPECT_LT(largest_difference(tensor_mean(pair, one, TensorInterpolation::kLogEuclidean), Mat3{2.0}), 1e-15);
  // One eigenvalue below zero is lifted to the floor: still a finite, positive tensor.
  const std::array negative{Mat3{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, -0.1}}, Mat3{1.0}};
  const Vec3 values =
      symmetric_eigenvalues(tensor_mean(negative, weights, TensorInterpolation::kLogEuclidean));
  EXPECT_NEAR(values[2], 1e-3, 1e-9);
}

}  // namespace
}  // namespace palpate
