#include "common/haptics/velocity_estimate.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

constexpr double kTick = 0.001;     // [s]
constexpr double kStep = 2.7e-5;    // [m] of the encoder
constexpr double kSlow = 0.0031;    // [m/s] a count each 9 ms
constexpr double kRounding = 1e-9;  // of a difference of positions over a tick

double quantised(double x) { return kStep * std::floor(x / kStep); }

TEST(VelocityEstimate, IsExactOnStraightMotionAtAnyRhythm) {
  VelocityEstimate estimate(kStep);
  const Vec3 v{0.3, -0.2, 0.05};
  double t = 5.0;
  EXPECT_EQ(estimate.update(t, v * t), Vec3(0.0)) << "the first position has no velocity";
  for (int k = 0; k < 40; ++k) {
    t += k % 3 == 0 ? 0.5 * kTick : 1.7 * kTick;
    EXPECT_NEAR(glm::distance(estimate.update(t, v * t), v), 0.0, kRounding);
  }
  EXPECT_EQ(estimate.window(), VelocityEstimate::kWindow - 1);
}

// A plain difference of a slow encoder is zero, or a count a tick: 27 mm/s where the hand does 3 mm/s. Over
// the whole window the ends are each within a step of the truth, so the error is a step over 15 ticks.
TEST(VelocityEstimate, SmoothsTheStepsOfAnEncoder) {
  VelocityEstimate estimate(kStep);
  double worst = 0.0;
  for (int k = 0; k < 1000; ++k) {
    const double t = kTick * k;
    const double v = estimate.update(t, {quantised(kSlow * t), 0.0, 0.0}).x;
    if (k > 30) worst = std::max(worst, std::abs(v - kSlow));
  }
  constexpr double kLongest = kTick * (VelocityEstimate::kWindow - 1);
  EXPECT_LE(worst, 1.01 * kStep / kLongest);
  EXPECT_GT(worst, 0.0);
}

// A hand that turns round within a tick: a window that went on past the turn would take 15 ms to see it.
TEST(VelocityEstimate, SeesAQuickTurnWithinThreeTicks) {
  VelocityEstimate estimate(kStep);
  constexpr double kSpeed = 0.5;  // [m/s] 18 steps a tick
  double x = 0.0;
  for (int k = 0; k < 100; ++k) {
    const bool back = k >= 50;
    x += (back ? -kSpeed : kSpeed) * kTick;
    const double v = estimate.update(kTick * k, {quantised(x), 0.0, 0.0}).x;
    if (k == 49) {
      EXPECT_NEAR(v, kSpeed, kStep / (10.0 * kTick));
    }
    if (k >= 53) {
      EXPECT_NEAR(v, -kSpeed, 1.01 * kStep / kTick);
    }
    if (k == 99) {
      EXPECT_NEAR(v, -kSpeed, kStep / (10.0 * kTick));
    }
  }
}

// Tremor of 8 Hz and 1 mm: in phase within half a window of two ticks at the noise that is set.
TEST(VelocityEstimate, FollowsATremor) {
  VelocityEstimate estimate(kStep);
  constexpr double kAngular = 2.0 * std::numbers::pi * 8.0, kAmplitude = 1e-3;
  double worst = 0.0;
  for (int k = 0; k < 1000; ++k) {
    const double t = kTick * k;
    const double v = estimate.update(t, {quantised(kAmplitude * std::sin(kAngular * t)), 0.0, 0.0}).x;
    if (k > 30) worst = std::max(worst, std::abs(v - kAmplitude * kAngular * std::cos(kAngular * t)));
  }
  EXPECT_LT(worst, 0.4 * kAmplitude * kAngular);
}

TEST(VelocityEstimate, IgnoresTimeThatDoesNotRiseAndForgets) {
  VelocityEstimate estimate(kStep);
  (void)estimate.update(1.0, Vec3{0.0});
  const Vec3 v = estimate.update(1.001, Vec3{0.001});
  EXPECT_EQ(estimate.update(1.001, Vec3{9.0}), v);
  EXPECT_EQ(estimate.update(0.5, Vec3{9.0}), v);
  EXPECT_EQ(estimate.update(1.002, Vec3{1e300}), Vec3(1e300) / (1.002 - 1.001)) << "still a number";
  EXPECT_EQ(estimate.update(1.003, Vec3{-1e308}), Vec3(0.0)) << "no number any more";
  estimate.reset();
  EXPECT_EQ(estimate.velocity(), Vec3(0.0));
  EXPECT_EQ(estimate.update(2.0, Vec3{5.0}), Vec3(0.0));
}

TEST(VelocityEstimate, ScalesByPowersOfTwo) {
  VelocityEstimate one(kStep), other(kStep * 0x1p20);
  for (int k = 0; k < 200; ++k) {
    const Vec3 x{std::sin(0.1 * k), std::cos(0.07 * k), 1e-3 * k};
    EXPECT_EQ(other.update(kTick * k, x * 0x1p20), one.update(kTick * k, x) * 0x1p20);
  }
}

TEST(VelocityEstimate, AllocatesNothing) {
  VelocityEstimate estimate(kStep);
  const AllocationGuard guard;
  for (int k = 0; k < 100; ++k) (void)estimate.update(kTick * k, Vec3{std::sin(0.1 * k)});
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace palpate::test
