// Errors of head tracking: the formulas against lines crossed independently.

#include "common/calibration/head_error.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

/// Where the line through a and b crosses the one through c and d: homogeneous coordinates, no shared
/// formula.
Vec2 crossing(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const Vec3 x = glm::cross(glm::cross(Vec3(a, 1.0), Vec3(b, 1.0)), glm::cross(Vec3(c, 1.0), Vec3(d, 1.0)));
  return Vec2(x) / x.z;
}

Vec2 seen(const EyePair& actual, const EyePair& modelled, const Vec2& point) {
  const Vec2 left{0.0}, right{1.0, 0.0};  // two points of the screen
  const Vec2 g = crossing(modelled.left, point, left, right),
             h = crossing(modelled.right, point, left, right);
  return crossing(actual.left, g, actual.right, h);
}

class HeadError : public testing::Test {
 protected:
  double within(double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(random_);
  }
  EyePair eyes() {
    const double x = within(-0.3, 0.3), z = within(0.4, 1.0), half = within(0.026, 0.037);
    return {{x - half, z}, {x + half, z}};
  }
  Vec2 point() {
    const double x = within(-0.4, 0.4), z = within(-0.6, 0.3);
    return {x, z};
  }
  std::mt19937 random_{11};
};

constexpr int kTimes = 2000;

TEST_F(HeadError, PerceivedPointIsWhereTheSeenRaysCross) {
  for (int i = 0; i < kTimes; ++i) {
    // Eyes at any two places: (2) does not need them at one distance.
    const EyePair actual = eyes();
    EyePair modelled = actual;
    for (Vec2* eye : {&modelled.left, &modelled.right}) {
      const double x = within(-0.02, 0.02), z = within(-0.02, 0.02);
      *eye += Vec2{x, z};
    }
    const Vec2 e = point(), expected = seen(actual, modelled, e);
    // A ray of small angle between the lines of sight magnifies rounding.
    if (glm::length(expected) > 10.0) continue;
    const auto f = perceived_point(actual, modelled, e);
    ASSERT_TRUE(f);
    EXPECT_LT(glm::distance(*f, expected), 1e-10);
  }
}

TEST_F(HeadError, EffectOfAPositionErrorIsExact) {
  for (int i = 0; i < kTimes; ++i) {
    const EyePair actual = eyes();
    const double x = within(-0.05, 0.05), z = within(-0.05, 0.05);
    const Vec2 error{x, z}, e = point();
    const Vec2 f = seen(actual, displaced(actual, error), e);
    EXPECT_NEAR(glm::distance(f, e), position_error_effect(actual.left.y, e, error), 1e-12);
  }
}

// Eq. 4.25 with 4.24 turned round; with the printed sense it would not hold.
TEST_F(HeadError, EffectOfAPositionErrorIsWithinItsBound) {
  constexpr double kLambda = 0.6, kKappa = 0.9;
  double largest = 0.0;
  for (int i = 0; i < kTimes; ++i) {
    const EyePair actual = eyes();
    const double eye_z = actual.left.y, x = within(-0.1, 0.1), z = within(-1.0, 1.0) * (1.0 - kKappa) * eye_z;
    const Vec2 error{x, z}, e{within(-0.4, 0.4), within(-1.0, 1.0) * kLambda * eye_z};
    const double ratio = glm::distance(seen(actual, displaced(actual, error), e), e) / glm::length(error);
    EXPECT_LE(ratio, position_error_bound(kLambda, kKappa) + 1e-9);
    largest = std::max(largest, ratio);
  }
  EXPECT_GT(largest, 0.8 * position_error_bound(kLambda, kKappa));  // and is not a loose one
}

TEST_F(HeadError, EffectOfAnOrientationErrorIsExact) {
  for (int i = 0; i < kTimes; ++i) {
    const EyePair actual = eyes();
    const double e = within(-0.004, 0.004);
    const Vec2 at = point(), f = seen(actual, turned(actual, e), at);
    if (glm::length(f) > 2.0) continue;  // in the degenerate region in front of the screen rounding grows
    const Vec2 effect = orientation_error_effect(actual, at, e);
    EXPECT_NEAR(std::abs(f.x - at.x), effect.x, 1e-12 * std::max(1.0, 1e3 * effect.x));
    EXPECT_NEAR(std::abs(f.y - at.y), effect.y, 1e-12 * std::max(1.0, 1e3 * effect.y));
  }
}

TEST_F(HeadError, LinearEffectOfAnOrientationErrorIsWrongToSecondOrder) {
  const EyePair actual{{-0.0315, 0.6}, {0.0315, 0.6}};
  const Vec2 at{0.1, -0.2};
  const auto error = [&](double e) {
    return orientation_error_effect(actual, at, e) - linear_orientation_error_effect(actual, at, e);
  };
  for (const int axis : {0, 1}) {
    const double order = std::log2(std::abs(error(1e-4)[axis]) / std::abs(error(5e-5)[axis]));
    EXPECT_NEAR(order, 2.0, 0.05) << axis;
  }
}

// The diamond of figure 4.15: no error on the screen, and none across it on the bisector but along x.
TEST_F(HeadError, VanishesOnTheScreen) {
  const EyePair actual = eyes();
  for (const double x : {-0.3, 0.0, 0.2}) {
    const auto f = perceived_point(actual, turned(actual, 0.003), {x, 0.0});
    ASSERT_TRUE(f);
    EXPECT_LT(glm::distance(*f, {x, 0.0}), 1e-14);
  }
}

TEST_F(HeadError, RefusesARayAlongTheScreen) {
  const EyePair actual{{-0.03, 0.5}, {0.03, 0.5}};
  EXPECT_FALSE(perceived_point(actual, actual, {0.2, 0.5}));
}

}  // namespace
}  // namespace palpate::test
