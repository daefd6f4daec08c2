// Errors of head tracking: the formulas against lines crossed independently.

#include "common/calibration/head_error.h"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

/// Twice the digits would do; these have eleven bits more than the formulas, so that what is compared is
/// their rounding and not that of the reference, which divides by the small angle between two rays.
using Exact = glm::tvec2<long double>;
using ExactEyes = std::array<Exact, 2>;

/// Where the line through a and b crosses the one through c and d: by homogeneous coordinates, which share no
/// formula with what is tested.
Exact crossing(const Exact& a, const Exact& b, const Exact& c, const Exact& d) {
  using Homogeneous = glm::tvec3<long double>;
  const auto at = [](const Exact& x) { return Homogeneous(x, 1.0L); };
  const Homogeneous x = glm::cross(glm::cross(at(a), at(b)), glm::cross(at(c), at(d)));
  return Exact(x) / x.z;
}

Exact seen(const ExactEyes& actual, const ExactEyes& modelled, const Vec2& point) {
  const Exact left{0.0L}, right{1.0L, 0.0L}, e{point};  // two points of the screen
  const Exact g = crossing(modelled[0], e, left, right), h = crossing(modelled[1], e, left, right);
  return crossing(actual[0], g, actual[1], h);
}

ExactEyes exact(const EyePair& eyes) { return {Exact{eyes.left}, Exact{eyes.right}}; }

/// F farther away than this is seen along rays that are all but parallel [m].
constexpr double kRoom = 10.0;
/// What is asserted of places in that room [m].
constexpr double kRounding = 1e-12;

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
    const Vec2 e = point();
    const Exact expected = seen(exact(actual), exact(modelled), e);
    if (glm::length(expected) > kRoom) continue;
    const auto f = perceived_point(actual, modelled, e);
    ASSERT_TRUE(f);
    EXPECT_LT(glm::distance(Exact{*f}, expected), kRounding);
  }
}

TEST_F(HeadError, EffectOfAPositionErrorIsExact) {
  for (int i = 0; i < kTimes; ++i) {
    const EyePair actual = eyes();
    const double x = within(-0.05, 0.05), z = within(-0.05, 0.05);
    const Vec2 error{x, z}, e = point();
    const Exact off{error};
    const Exact f = seen(exact(actual), {Exact{actual.left} + off, Exact{actual.right} + off}, e);
    constexpr double kFewUlp = 1e-15;  // [m] of some centimetres
    EXPECT_NEAR(static_cast<double>(glm::distance(f, Exact{e})),
                position_error_effect(actual.left.y, e, error), kFewUlp);
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
    const Exact f = seen(exact(actual), exact(displaced(actual, error)), e);
    const double ratio = static_cast<double>(glm::distance(f, Exact{e})) / glm::length(error);
    EXPECT_LE(ratio, position_error_bound(kLambda, kKappa) + 1e-9);
    largest = std::max(largest, ratio);
  }
  EXPECT_GT(largest, 0.8 * position_error_bound(kLambda, kKappa));  // and is not a loose one
}

TEST_F(HeadError, EffectOfAnOrientationErrorIsExact) {
  for (int i = 0; i < kTimes; ++i) {
    const EyePair actual = eyes();
    const double e = within(-0.004, 0.004);
    const Vec2 at = point();
    const Exact off{0.0L, static_cast<long double>(e)};
    const Exact f = seen(exact(actual), {Exact{actual.left} - off, Exact{actual.right} + off}, at);
    if (glm::length(f) > kRoom) continue;
    const Vec2 effect = orientation_error_effect(actual, at, e);
    EXPECT_NEAR(static_cast<double>(std::abs(f.x - at.x)), effect.x, kRounding);
    EXPECT_NEAR(static_cast<double>(std::abs(f.y - at.y)), effect.y, kRounding);
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
