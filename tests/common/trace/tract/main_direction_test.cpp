// The eigenvector by iteration beside the one by Jacobi rotations; measures beside those of eigenvalues.

#include "common/trace/tract/main_direction.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace palpate {
namespace {

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-52 - 1.0; }

Vec3 random_direction(std::mt19937_64& random) {
  for (;;) {
    const double x = unit(random), y = unit(random), z = unit(random);
    const Vec3 v{x, y, z};
    const double length = glm::length(v);
    if (length > 0.1 && length < 1.0) return v / length;
  }
}

Tensor6 with_eigenvalues(const Vec3& values, std::mt19937_64& random) {
  const Vec3 a = random_direction(random);
  const Vec3 b = glm::normalize(glm::cross(a, random_direction(random)));
  const Mat3 v{a, b, glm::cross(a, b)};
  Mat3 d{0.0};
  for (int i = 0; i < 3; ++i) d += values[i] * glm::outerProduct(v[i], v[i]);
  return {d[0][0], d[1][0], d[2][0], d[1][1], d[2][1], d[2][2]};
}

TEST(MainDirection, IsTheLargestEigenvectorFromAnyStart) {
  std::mt19937_64 random{7};
  for (int n = 0; n < 20'000; ++n) {
    const double second = 0.3 * (unit(random) + 1.0);
    const Vec3 values{0.7, second, 0.5 * second * unit(random)};
    const Tensor6 d = with_eigenvalues(values, random);
    const Vec3 expected = symmetric_eigen(d.matrix()).vectors[0];
    const Vec3 toward = random_direction(random);
    const Vec3 found = main_direction(d, toward);
    ASSERT_GE(glm::dot(found, toward), 0.0);
    ASSERT_NEAR(glm::length(found), 1.0, 1e-14);
    const double gap = (0.7 - second) / 0.7;
    ASSERT_LT(glm::length(glm::cross(found, expected)), 1e-8 / gap) << values.y << " " << values.z;
  }
}

TEST(MainDirection, NeverTakesALesserEigenvectorThatItStartsOn) {
  std::mt19937_64 random{8};
  for (int n = 0; n < 1000; ++n) {
    const Tensor6 d = with_eigenvalues({0.6, 0.3, 0.1}, random);
    const SymmetricEigen eigen = symmetric_eigen(d.matrix());
    for (int lesser : {1, 2}) {
      EXPECT_LT(glm::length(glm::cross(main_direction(d, eigen.vectors[lesser]), eigen.vectors[0])), 1e-12);
    }
  }
}

TEST(MainDirection, IsSomeUnitVectorWhereItIsUndefined) {
  for (const Tensor6& d : {Tensor6{}, Tensor6{.xx = 0.3, .yy = 0.3, .zz = 0.3},
                           Tensor6{.xx = 0.4, .yy = 0.4, .zz = 0.1}, Tensor6{.xx = -0.4, .yy = -0.4}}) {
    const Vec3 found = main_direction(d, {0.6, 0.8, 0.0});
    EXPECT_NEAR(glm::length(found), 1.0, 1e-14);
    // It does diffuse most along what is found.
    EXPECT_NEAR(glm::dot(found, d * found), symmetric_eigenvalues(d.matrix())[0], 1e-15);
  }
}

TEST(TensorMeasure, IsThatOfTheEigenvalues) {
  std::mt19937_64 random{9};
  for (int n = 0; n < 5000; ++n) {
    const double a = unit(random), b = unit(random), c = unit(random);
    const Tensor6 d = with_eigenvalues({a, b, c}, random);
    const Vec3 values = symmetric_eigenvalues(d.matrix());
    // The square root of a difference that is small where the tensor is nearly isotropic.
    ASSERT_NEAR(measure_of(TractMeasure::kFa, d), fractional_anisotropy(values), 1e-7);
    ASSERT_EQ(measure_of(TractMeasure::kLinear, d), anisotropy(values).linear);
  }
}

}  // namespace
}  // namespace palpate
