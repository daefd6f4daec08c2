#include "common/device/hand_model.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

constexpr double kTick = 0.001;  // [s]

TEST(Operator, SeesAStepAfterTheReactionAndThenLagsBehindIt) {
  const OperatorSettings settings{.reaction = 0.2, .lag = 0.1, .tremor = 0.0};
  Operator hand(settings);
  hand.place(50.0, Vec3{0.0});
  const Vec3 target{0.01, -0.02, 0.03};
  for (int n = 1; n <= 1000; ++n) {
    const double t = kTick * n;
    const Vec3 x = hand.follow(50.0 + t, n >= 100 ? target : Vec3{0.0});
    // The step lies between the targets of 99 and 100 ms; shown from 299 ms on.
    const double seen = t - 0.1 - settings.reaction;
    if (seen <= -kTick) {
      EXPECT_EQ(x, Vec3(0.0)) << n;
    }
    if (seen >= kTick) {
      EXPECT_NEAR(x.z, target.z * (1.0 - std::exp(-seen / settings.lag)),
                  2.0 * target.z * kTick / settings.lag);
    }
  }
}

// Ticks in between targets of another rhythm: the delay is one of time, not of ticks.
TEST(Operator, DelaysAMovingTargetByTheSameTimeAtAnyRate) {
  for (const double rate : {100.0, 1000.0, 10'000.0}) {
    Operator hand({.reaction = 0.35, .lag = 0.0, .tremor = 0.0});
    const auto path = [](double t) { return Vec3{0.1 * t, std::sin(3.0 * t), 0.0}; };
    for (double t = 0.0; t < 3.0; t += 1.0 / rate) {
      const Vec3 x = hand.follow(t, path(t));
      if (t > 1.0) {
        EXPECT_NEAR(x.x, 0.1 * (t - 0.35), 1e-12) << rate;
        // Straight between targets at 10 ms or less.
        EXPECT_NEAR(x.y, std::sin(3.0 * (t - 0.35)), 9.0 / 8.0 * 1e-4 + 1e-9) << rate;
      }
    }
  }
}

TEST(Operator, TremblesBetween8And12HertzAsTheSeedSays) {
  const OperatorSettings settings{.tremor = 1e-4, .seed = 7};
  Operator hand(settings), same(settings);
  Operator other({.tremor = 1e-4, .seed = 8});
  double square = 0.0;
  int rises = 0, differs = 0;
  double last = 0.0;
  constexpr int kTicks = 20'000;
  for (int n = 0; n < kTicks; ++n) {
    const Vec3 x = hand.follow(kTick * n, Vec3{0.0});
    EXPECT_EQ(same.follow(kTick * n, Vec3{0.0}), x);
    differs += other.follow(kTick * n, Vec3{0.0}) == x ? 0 : 1;
    square += x.x * x.x;
    rises += last < 0.0 && x.x >= 0.0 ? 1 : 0;
    last = x.x;
    EXPECT_EQ(hand.aim(), Vec3(0.0));
  }
  EXPECT_NEAR(std::sqrt(square / kTicks), settings.tremor, 0.1 * settings.tremor);
  EXPECT_GE(rises, 8 * 20 - 2);
  EXPECT_LE(rises, 12 * 20 + 2);
  EXPECT_GT(differs, kTicks / 2);
}

TEST(Operator, AllocatesNothing) {
  Operator hand;
  const AllocationGuard guard;
  for (int n = 0; n < 2000; ++n) (void)hand.follow(kTick * n, Vec3{1e-3 * n});
  EXPECT_EQ(guard.count(), 0U);
}

TEST(HandImpedance, IsKnownByName) {
  EXPECT_EQ(find_hand("firm"), kFirmHand);
  EXPECT_EQ(find_hand("relaxed"), kRelaxedHand);
  EXPECT_GT(kFirmHand.stiffness, kRelaxedHand.stiffness);
  EXPECT_THROW((void)find_hand("limp"), Error);
}

}  // namespace
}  // namespace palpate::test
