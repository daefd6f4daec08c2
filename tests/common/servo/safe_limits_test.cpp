// What the safety stage makes of the limits of every class of devices, whatever the chain asks for.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/device/device_profile.h"
#include "common/servo/safety_stage.h"

namespace palpate::test {
namespace {

constexpr double kStep = 0.001;  // [s]

class SafeLimits : public ::testing::TestWithParam<DeviceProfile> {
 protected:
  DeviceLimits limits_ = safe_limits(GetParam());
  SafetyStage stage_{limits_};

  /// More than any device has.
  static ForceRequest strong() { return {.force = {600.0, -800.0, 0.0}, .dt = kStep}; }
  Vec3 after(double seconds) {
    Vec3 force{0.0};
    for (int n = 0; n < static_cast<int>(std::lround(seconds / kStep)); ++n) force = stage_.apply(strong());
    return force;
  }
};

TEST_P(SafeLimits, AreUsable) { EXPECT_TRUE(limits_.valid()); }

TEST_P(SafeLimits, TheForceGrowsOverHalfASecondToThePeakAndNoFaster) {
  Vec3 before{0.0};
  for (int n = 1; n <= 1000; ++n) {
    const Vec3 force = stage_.apply(strong());
    ASSERT_LE(glm::length(force), GetParam().peak_force * std::min(1.0, n * kStep / 0.5) * (1.0 + 1e-12));
    // Warm motors bring it down at once.
    if (glm::length(force) >= glm::length(before)) {
      ASSERT_LE(glm::distance(force, before), 200.0 * kStep * (1.0 + 1e-12));
    }
    before = force;
  }
}

TEST_P(SafeLimits, WhatLastsComesDownToWhatTheMotorsStand) {
  const double most = std::min(GetParam().peak_force, GetParam().continuous_force);
  EXPECT_NEAR(glm::length(after(20.0)), most, 0.01 * most);
}

TEST_P(SafeLimits, AHandThatIsTooFastGetsNoForceUntilItIsArmedAgain) {
  EXPECT_GT(glm::length(after(1.0)), 1.0);
  ForceRequest fast = strong();
  fast.speed = 1.6;
  EXPECT_EQ(stage_.apply(fast), Vec3(0.0));
  EXPECT_EQ(after(1.0), Vec3(0.0));
  stage_.arm();
  EXPECT_GT(glm::length(after(1.0)), 1.0);
}

TEST_P(SafeLimits, AFaultLastsUntilItIsArmedAgain) {
  (void)after(1.0);
  ForceRequest bad = strong();
  bad.force.x = std::nan("");
  EXPECT_EQ(stage_.apply(bad), Vec3(0.0));
  EXPECT_EQ(after(1.0), Vec3(0.0));
  stage_.arm();
  EXPECT_GT(glm::length(after(1.0)), 1.0);
}

TEST_P(SafeLimits, OutsideOfTheReachThereIsNoForce) {
  ForceRequest at = strong();
  at.position = 0.51 * GetParam().reach;
  (void)after(1.0);
  EXPECT_EQ(stage_.apply(at), Vec3(0.0));
  EXPECT_EQ(stage_.cut(), ForceCut::kOutOfReach);
}

INSTANTIATE_TEST_SUITE_P(OfEveryClass, SafeLimits,
                         ::testing::ValuesIn(device_profiles().begin(), device_profiles().end()),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace palpate::test
