#include "common/math/symmetric3.h"

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace palpate {
namespace {

/// A few units of rounding, relative to the largest eigenvalue.
constexpr double kRounding = 4e-15;

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }

/// A random rotation from a random quaternion.
Mat3 random_rotation(std::mt19937_64& random) {
  Vec4 q{2.0 * unit(random) - 1.0, 2.0 * unit(random) - 1.0, 2.0 * unit(random) - 1.0,
         2.0 * unit(random) - 1.0};
  q = glm::normalize(q);
  const auto [w, x, y, z] = std::array{q.x, q.y, q.z, q.w};
  return {Vec3{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
          Vec3{2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
          Vec3{2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

Mat3 with_spectrum(const Mat3& v, const Vec3& values) {
  return v * Mat3{Vec3{values.x, 0, 0}, Vec3{0, values.y, 0}, Vec3{0, 0, values.z}} * glm::transpose(v);
}

constexpr std::array<std::array<double, 3>, 11> kSpectra{{{3, 2, 1},
                                                          {1, 0, -1},
                                                          {1, 1, 1},
                                                          {2, 2, -1},
                                                          {2, -1, -1},
                                                          {0, 0, 0},
                                                          {1, 0, 0},
                                                          {1, 1 - 1e-15, 1 - 2e-15},
                                                          {1, 1e-8, -1e-8},
                                                          {1, 1e-16, -1e-20},
                                                          {-1, -2, -1e6}}};

TEST(SymmetricEigen, KnownSpectraAreFoundInAnyFrameAndAtAnyScale) {
  std::mt19937_64 random(1);
  for (const double scale : {1.0, 1e30, 1e-30, 1e300, 1e-290}) {
    for (const auto& spectrum : kSpectra) {
      const Vec3 values{spectrum[0], spectrum[1], spectrum[2]};
      const double largest = std::max(1e-300, std::max(std::abs(values.x), std::abs(values.z)));
      for (int i = 0; i < 50; ++i) {
        const Mat3 a = with_spectrum(random_rotation(random), values) * scale;
        const SymmetricEigen found = symmetric_eigen(a);
        for (int k = 0; k < 3; ++k) {
          EXPECT_NEAR(found.values[k] / scale, values[k], kRounding * largest);
          const Vec3 v = found.vectors[k];
          EXPECT_LT(glm::length(a * v / scale - found.values[k] / scale * v), 2.0 * kRounding * largest);
        }
        EXPECT_EQ(symmetric_eigenvalues(a), found.values);
      }
    }
  }
}

TEST(SymmetricEigen, VectorsAreOrthonormalAndRightHandedWhateverTheSpectrum) {
  std::mt19937_64 random(2);
  for (const auto& spectrum : kSpectra) {
    for (int i = 0; i < 50; ++i) {
      const Mat3 v =
          symmetric_eigen(with_spectrum(random_rotation(random), {spectrum[0], spectrum[1], spectrum[2]}))
              .vectors;
      const Mat3 product = glm::transpose(v) * v;
      for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) EXPECT_NEAR(product[c][r], c == r ? 1.0 : 0.0, kRounding);
      }
      EXPECT_GT(glm::determinant(v), 0.5);
    }
  }
}

TEST(SymmetricEigen, DiagonalMatricesAreTheirOwnSpectrum) {
  const Mat3 a{Vec3{-1.0, 0, 0}, Vec3{0, 7.0, 0}, Vec3{0, 0, 2.0}};
  EXPECT_EQ(symmetric_eigenvalues(a), Vec3(7.0, 2.0, -1.0));
}

TEST(SymmetricEigen, PowersOfTwoScaleExactly) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 100; ++i) {
    const Mat3 a = with_spectrum(random_rotation(random), {3.0, -0.2, -7.0});
    for (const int exponent : {60, -60, 1000, -900}) {
      EXPECT_EQ(symmetric_eigenvalues(a * std::ldexp(1.0, exponent)),
                symmetric_eigenvalues(a) * std::ldexp(1.0, exponent));
    }
  }
}

TEST(SymmetricEigen, NaNComesOutAsNaN) {
  Mat3 a{1.0};
  a[0][2] = std::numeric_limits<double>::quiet_NaN();
  for (int k = 0; k < 3; ++k) {
    EXPECT_TRUE(std::isnan(symmetric_eigenvalues(a)[k]));
    EXPECT_TRUE(std::isnan(symmetric_eigen(a).vectors[k].x));
  }
}

}  // namespace
}  // namespace palpate
