#include "common/field/tensor/diffusion_measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace palpate {
namespace {

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }

Vec3 falling(std::mt19937_64& random, double least) {
  std::array<double, 3> v{};
  for (double& value : v) value = least + (1.0 - least) * unit(random);
  std::sort(v.begin(), v.end());
  return {v[2], v[1], v[0]};
}

// Eigenvalues 4, 2, 1: thirds of seven, or quarters.
TEST(DiffusionMeasures, LinearPlanarAndSphericalPartsComeInTwoScales) {
  const Vec3 values{4.0, 2.0, 1.0};
  const Anisotropy trace = anisotropy(values, WestinScale::kTrace);
  EXPECT_EQ(trace.linear, anisotropy(values).linear);
  EXPECT_NEAR(trace.linear, 2.0 / 7.0, 1e-15);
  EXPECT_NEAR(trace.planar, 2.0 / 7.0, 1e-15);
  EXPECT_NEAR(trace.spherical, 3.0 / 7.0, 1e-15);
  const Anisotropy largest = anisotropy(values, WestinScale::kLargest);
  EXPECT_EQ(largest.linear, 0.5);
  EXPECT_EQ(largest.planar, 0.25);
  EXPECT_EQ(largest.spherical, 0.25);
  EXPECT_EQ(anisotropy({0.0, 0.0, 0.0}, WestinScale::kLargest).spherical, 1.0);
  EXPECT_EQ(anisotropy({2.0, 1.0, -1.0}, WestinScale::kLargest).planar, 0.5);
}

TEST(DiffusionMeasures, PureFormsAreAtTheCorners) {
  const Anisotropy line = anisotropy({3.0, 0.0, 0.0}), plane = anisotropy({3.0, 3.0, 0.0}),
                   ball = anisotropy({3.0, 3.0, 3.0});
  EXPECT_EQ(line.linear, 1.0);
  EXPECT_EQ(plane.planar, 1.0);
  EXPECT_EQ(ball.spherical, 1.0);
  EXPECT_EQ(fractional_anisotropy({3.0, 0.0, 0.0}), 1.0);
  EXPECT_NEAR(fractional_anisotropy({3.0, 3.0, 0.0}), std::sqrt(0.5), 1e-15);
  EXPECT_EQ(fractional_anisotropy({3.0, 3.0, 3.0}), 0.0);
  EXPECT_NEAR(mode_of_anisotropy({3.0, 1.0, 1.0}), 1.0, 1e-15);
  EXPECT_NEAR(mode_of_anisotropy({3.0, 3.0, 1.0}), -1.0, 1e-15);
  EXPECT_NEAR(mode_of_anisotropy({3.0, 2.0, 1.0}), 0.0, 1e-15);
  EXPECT_EQ(mode_of_anisotropy({3.0, 3.0, 3.0}), 0.0);
}

// FA by its definition over the deviator, mode by the invariants of Criscione et al. 2000.
TEST(DiffusionMeasures, AgreeWithTheirDefinitions) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 v = falling(random, 0.0);
    const double mean = (v.x + v.y + v.z) / 3.0;
    const Vec3 deviator = v - Vec3{mean};
    EXPECT_NEAR(fractional_anisotropy(v), std::sqrt(1.5) * glm::length(deviator) / glm::length(v), 1e-14);
    EXPECT_NEAR(mean_diffusivity(v), mean, 1e-15);
    const double third = deviator.x * deviator.y * deviator.z;
    EXPECT_NEAR(mode_of_anisotropy(v), 3.0 * std::sqrt(6.0) * third / std::pow(glm::length(deviator), 3),
                1e-9);
    const Anisotropy parts = anisotropy(v);
    EXPECT_NEAR(parts.linear, (v.x - v.y) / (3.0 * mean), 1e-15);
    EXPECT_NEAR(parts.planar, 2.0 * (v.y - v.z) / (3.0 * mean), 1e-15);
  }
}

TEST(DiffusionMeasures, StayInTheirRangesWhereEigenvaluesAreNegative) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 v = falling(random, -1.0);
    const Anisotropy parts = anisotropy(v);
    for (const double part : {parts.linear, parts.planar, parts.spherical, fractional_anisotropy(v)}) {
      EXPECT_GE(part, 0.0);
      EXPECT_LE(part, 1.0);
    }
    EXPECT_NEAR(parts.linear + parts.planar + parts.spherical, 1.0, 1e-15);
    EXPECT_LE(std::abs(mode_of_anisotropy(v)), 1.0);
    EXPECT_GE(mean_diffusivity(v), 0.0);
    EXPECT_EQ(has_negative(v), v.z < 0.0);
  }
  EXPECT_EQ(anisotropy({-1.0, -2.0, -3.0}).spherical, 1.0);
  EXPECT_EQ(fractional_anisotropy({-1.0, -2.0, -3.0}), 0.0);
}

TEST(DiffusionMeasures, HaveNoUnit) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 200; ++i) {
    const Vec3 v = falling(random, 0.05);
    for (const double scale : {0x1p-990, 0x1p-300, 0x1p40, 0x1p1020}) {
      const Vec3 w = v * scale;
      EXPECT_EQ(anisotropy(w).linear, anisotropy(v).linear);
      EXPECT_EQ(anisotropy(w).planar, anisotropy(v).planar);
      EXPECT_EQ(fractional_anisotropy(w), fractional_anisotropy(v));
      EXPECT_EQ(mode_of_anisotropy(w), mode_of_anisotropy(v));
      EXPECT_NEAR(mean_diffusivity(w) / scale, mean_diffusivity(v), 1e-15);
    }
  }
}

TEST(DiffusionMeasures, NaNStaysNaNAndNothingIsIsotropic) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(anisotropy(Vec3{kNaN}).linear));
  EXPECT_TRUE(std::isnan(fractional_anisotropy(Vec3{kNaN})));
  EXPECT_TRUE(std::isnan(mode_of_anisotropy(Vec3{kNaN})));
  EXPECT_TRUE(std::isnan(mean_diffusivity(Vec3{kNaN})));
  EXPECT_EQ(anisotropy(Vec3{0.0}).spherical, 1.0);
  EXPECT_EQ(fractional_anisotropy(Vec3{0.0}), 0.0);
  EXPECT_EQ(mode_of_anisotropy(Vec3{0.0}), 0.0);
}

}  // namespace
}  // namespace palpate
