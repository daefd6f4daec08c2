#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "common/servo/safety_stage.h"

namespace palpate::test {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kLargest = std::numeric_limits<double>::max();
constexpr double kDenormal = std::numeric_limits<double>::denorm_min();
constexpr double kRounding = 1e-12;

TEST(SafetyRules, CapKeepsTheDirectionOfAnyFiniteForce) {
  EXPECT_EQ(capped({1, 2, 2}, 3.0), Vec3(1, 2, 2));
  EXPECT_EQ(capped(Vec3{0.0}, 3.0), Vec3(0.0));
  EXPECT_EQ(capped({0, -8, 0}, 4.0), Vec3(0, -4, 0));
  EXPECT_EQ(capped({kDenormal, 0, 0}, 4.0), Vec3(kDenormal, 0, 0));
  EXPECT_EQ(capped({kDenormal, 0, 0}, 0.0), Vec3(0.0));
  const Vec3 huge = capped(Vec3{kLargest, -kLargest, kLargest}, 3.0);
  EXPECT_NEAR(glm::length(huge), 3.0, 3.0 * kRounding);
  EXPECT_NEAR(huge.x, std::sqrt(3.0), kRounding * 4.0);
  EXPECT_EQ(huge.y, -huge.x);
}

TEST(SafetyRules, SlewGoesStraightToWhatIsWantedAndNoFurther) {
  EXPECT_EQ(slewed({1, 0, 0}, {1, 0.5, 0}, 1.0), Vec3(1, 0.5, 0));
  EXPECT_EQ(slewed({1, 0, 0}, {1, 4, 0}, 1.0), Vec3(1, 1, 0));
  EXPECT_EQ(slewed({1, 2, 3}, {5, 5, 5}, 0.0), Vec3(1, 2, 3));
}

TEST(SafetyRules, FadeIsStraightHoweverItsTimeIsCut) {
  // 40 ms of a fade of 50 ms leave a fifth, in one step or in many.
  EXPECT_NEAR(faded({1, -2, 0}, 0.040, 0.050).y, -0.4, 1e-15);
  Vec3 force{1, -2, 0};
  for (int i = 0; i < 40; ++i) force = faded(force, 0.001, 0.050 - 0.001 * i);
  EXPECT_NEAR(force.y, -0.4, 1e-14);
  EXPECT_EQ(faded({1, 0, 0}, 0.050, 0.050), Vec3(0.0));
  EXPECT_EQ(faded({1, 0, 0}, 0.001, 0.0), Vec3(0.0));
  EXPECT_EQ(faded({1, 0, 0}, 0.001, -1.0), Vec3(0.0)) << "no time left";
}

TEST(SafetyRules, WarmingIsThatOfAFirstOrderBody) {
  // From cold, a steady 2 N of time constant 3 s: h = 4 (1 - e^(-t / 3)).
  EXPECT_NEAR(warmed(0.0, {2, 0, 0}, 1.5, 3.0), 4.0 * (1.0 - std::exp(-0.5)), 1e-15);
  double heat = 0.0;
  for (int i = 0; i < 1500; ++i) heat = warmed(heat, {0, 2, 0}, 0.001, 3.0);
  EXPECT_NEAR(heat, 4.0 * (1.0 - std::exp(-0.5)), 1e-12) << "steps of any length give the same";
  EXPECT_NEAR(warmed(heat, Vec3{0.0}, 6.0, 3.0), heat * std::exp(-2.0), 1e-15);
  EXPECT_EQ(warmed(heat, {1, 0, 0}, kInf, 3.0), 1.0);
}

TEST(SafetyRules, CapGrowsFromZeroAndComesDownToWhatMayLast) {
  const DeviceLimits limits{.force_cap = 8.0, .start_ramp = 0.5, .continuous_cap = 2.0};
  EXPECT_EQ(cap_after(limits, 0.0, 0.0), 0.0);
  EXPECT_EQ(cap_after(limits, 0.125, 0.0), 2.0);
  EXPECT_EQ(cap_after(limits, 0.5, 0.0), 8.0);
  EXPECT_EQ(cap_after(limits, 9.0, 4.0), 2.0) << "as warm as may be";
  EXPECT_EQ(cap_after(limits, 9.0, 50.0), 2.0) << "never below what may last";
  EXPECT_NEAR(cap_after(limits, 9.0, 3.0), std::sqrt(4.0 + 60.0 * 0.25), 1e-14);
  EXPECT_EQ(cap_after({.force_cap = 8.0}, 0.0, 1e9), 8.0) << "neither is asked for";
}

TEST(SafetyRules, EdgePushesBackFromEachBorderOfTheReach) {
  const DeviceLimits limits{.reach_lower = {-0.1, -0.2, -0.3},
                            .reach_upper = {0.1, 0.2, 0.3},
                            .edge_margin = 0.01,
                            .edge_stiffness = 300.0};
  EXPECT_EQ(edge_push(limits, {0.0, 0.0, 0.0}), Vec3(0.0));
  EXPECT_EQ(edge_push(limits, {0.089, -0.189, 0.0}), Vec3(0.0));
  EXPECT_NEAR(glm::distance(edge_push(limits, {0.095, 0.0, -0.3}), Vec3(-1.5, 0.0, 3.0)), 0.0, 1e-12);
  EXPECT_EQ(edge_push({}, {1e300, -1e300, 0.0}), Vec3(0.0)) << "nothing bounds it";
  EXPECT_TRUE(within_reach(limits, {0.1, -0.2, 0.3}));
  EXPECT_FALSE(within_reach(limits, {0.1001, 0.0, 0.0}));
  EXPECT_FALSE(within_reach(limits, {0.0, kNan, 0.0}));
  EXPECT_TRUE(within_reach({}, {1e300, -1e300, 0.0}));
}

TEST(SafetyRules, EnablingButtonCountsOnlyWhileItIsFresh) {
  EXPECT_TRUE(is_enabled({}, 0, kInf)) << "none is needed";
  const DeviceLimits limits{.enabling_button = 3};
  EXPECT_TRUE(is_enabled(limits, 0b1000, 0.0));
  EXPECT_TRUE(is_enabled(limits, 0b1010, kEnablingStale));
  EXPECT_FALSE(is_enabled(limits, 0b0111, 0.0));
  EXPECT_FALSE(is_enabled(limits, 0b1000, kEnablingStale + 0.001));
  EXPECT_FALSE(is_enabled(limits, 0b1000, kNan));
  EXPECT_TRUE(is_enabled({.enabling_button = 31}, 1U << 31U, 0.0));
  EXPECT_LE(kEnablingStale + DeviceLimits{}.fade_time, 0.095) << "from losing it to zero, but the steps";
}

TEST(SafetyRules, EachCutHasItsName) {
  std::set<std::string_view> names;
  for (int i = 0; i < kForceCutCount; ++i) names.insert(name_of(static_cast<ForceCut>(i)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kForceCutCount));
  EXPECT_EQ(name_of(ForceCut::kSwitchedOff), "switched_off");
  EXPECT_EQ(name_of(ForceCut::kChain), "chain");
}

TEST(DeviceLimits, RefusesWhatNoDeviceCanHave) {
  EXPECT_TRUE(DeviceLimits{}.valid());
  for (const DeviceLimits& limits :
       {DeviceLimits{.force_cap = 0.0}, DeviceLimits{.force_cap = kInf}, DeviceLimits{.slew_cap = -1.0},
        DeviceLimits{.velocity_gate = kNan}, DeviceLimits{.stale_after = 0.0},
        DeviceLimits{.start_ramp = -0.1}, DeviceLimits{.fade_time = kNan}, DeviceLimits{.fade_time = kInf},
        DeviceLimits{.continuous_cap = 0.0}, DeviceLimits{.heating_time = 0.0},
        DeviceLimits{.reach_lower = {0, 0, 1}, .reach_upper = {1, 1, 1}},
        DeviceLimits{.reach_upper = {1, kNan, 1}}, DeviceLimits{.edge_margin = -1.0},
        DeviceLimits{.edge_stiffness = kInf}, DeviceLimits{.enabling_button = -2},
        DeviceLimits{.enabling_button = 32}}) {
    EXPECT_FALSE(limits.valid());
  }
}

}  // namespace
}  // namespace palpate::test
