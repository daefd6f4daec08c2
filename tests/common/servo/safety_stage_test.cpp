#include "common/servo/safety_stage.h"

#include <algorithm>
#include <array>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kLargest = std::numeric_limits<double>::max();
constexpr double kDenormal = std::numeric_limits<double>::denorm_min();
constexpr double kRounding = 1e-12;  // relative; some thousand roundings

/// A force after so many ordinary steps that no limit of rate is felt any more.
SafetyStage settled(const DeviceLimits& limits, const Vec3& force) {
  SafetyStage stage(limits);
  for (int i = 0; i < 1000; ++i) (void)stage.apply({.force = force, .dt = 0.01});
  return stage;
}

TEST(Capped, KeepsTheDirectionOfAnyFiniteForce) {
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

TEST(SafetyStage, GrowsTurnsAndFallsNoFasterThanTheSlewLimitButDropsToZeroAtOnce) {
  SafetyStage stage({.force_cap = 4.0, .slew_cap = 100.0});
  EXPECT_NEAR(stage.apply({.force = {1, 0, 0}, .dt = 0.001}).x, 0.1, 1e-15);
  EXPECT_NEAR(stage.apply({.force = {1, 0, 0}, .dt = 0.002}).x, 0.3, 1e-15);
  stage = settled(stage.limits(), {1, 0, 0});
  EXPECT_NEAR(stage.apply({.force = {0.5, 0, 0}, .dt = 0.001}).x, 0.9, 1e-15) << "a partial fall";
  EXPECT_EQ(stage.apply({.force = Vec3{0.0}, .dt = 0.001}), Vec3(0.0));
  EXPECT_EQ(stage.cut(), ForceCut::kNone) << "zero was wanted";
  stage = settled(stage.limits(), {1, 0, 0});
  EXPECT_NEAR(glm::distance(stage.apply({.force = {0, 1, 0}, .dt = 0.001}), Vec3(1, 0, 0)), 0.1, 1e-15);
}

TEST(SafetyStage, LetsALongPauseBuyNoLargerChange) {
  SafetyStage stage({.force_cap = 4.0, .slew_cap = 100.0});
  EXPECT_NEAR(stage.apply({.force = {4, 0, 0}, .dt = 3600.0}).x, 2.0, 1e-15);
}

TEST(SafetyStage, CutsForEachReasonAndGrowsFromZeroAfterIt) {
  struct Case {
    ForceRequest request;
    ForceCut cut;
    bool fault;
  };
  const Vec3 pull{1, 0, 0};
  const std::array cases{
      Case{{.force = {kNan, 0, 0}, .dt = 0.001}, ForceCut::kNotFinite, true},
      Case{{.force = {0, 0, -kInf}, .dt = 0.001}, ForceCut::kNotFinite, true},
      Case{{.force = pull, .dt = 0.0}, ForceCut::kTime, true},
      Case{{.force = pull, .dt = -0.001}, ForceCut::kTime, true},
      Case{{.force = pull, .dt = kNan}, ForceCut::kTime, true},
      Case{{.force = pull, .dt = 0.001, .age = 0.11}, ForceCut::kStale, true},
      Case{{.force = pull, .dt = 0.001, .age = kNan}, ForceCut::kStale, true},
      Case{{.force = pull, .dt = 0.001, .cut = ForceCut::kJump}, ForceCut::kJump, false},
      Case{{.force = pull, .dt = 0.001, .cut = ForceCut::kChain}, ForceCut::kChain, true},
  };
  for (const Case& c : cases) {
    SafetyStage stage = settled({.slew_cap = 100.0}, pull);
    EXPECT_EQ(stage.apply(c.request), Vec3(0.0)) << name_of(c.cut);
    EXPECT_EQ(stage.cut(), c.cut) << name_of(c.cut);
    EXPECT_EQ(is_fault(stage.cut()), c.fault) << name_of(c.cut);
    EXPECT_NEAR(stage.apply({.force = pull, .dt = 0.001}).x, 0.1, 1e-15) << name_of(c.cut);
  }
}

TEST(SafetyStage, LatchesTheSwitchAndTheVelocityGateUntilArmed) {
  SafetyStage stage = settled({.velocity_gate = 1.0}, {1, 0, 0});
  EXPECT_GT(stage.apply({.force = {1, 0, 0}, .dt = 0.001, .speed = 1.0}).x, 0.0);
  EXPECT_EQ(stage.apply({.force = {1, 0, 0}, .dt = 0.001, .speed = 1.01}), Vec3(0.0));
  for (int i = 0; i < 10; ++i) EXPECT_EQ(stage.apply({.force = {1, 0, 0}, .dt = 0.001}), Vec3(0.0));
  EXPECT_EQ(stage.cut(), ForceCut::kTooFast);
  EXPECT_FALSE(stage.armed());
  stage.arm();
  EXPECT_NEAR(stage.apply({.force = {1, 0, 0}, .dt = 0.001}).x, 0.2, 1e-15) << "from zero";
  stage.switch_off();
  EXPECT_EQ(stage.apply({.force = {1, 0, 0}, .dt = 0.001}), Vec3(0.0));
  EXPECT_EQ(stage.cut(), ForceCut::kSwitchedOff);
  EXPECT_EQ(
      settled({.velocity_gate = kInf}, {1, 0, 0}).apply({.force = {1, 0, 0}, .dt = 0.001, .speed = kInf}),
      Vec3(1, 0, 0))
      << "no gate";
}

TEST(SafetyStage, StartsWithASmallForceWhereAskedButNotAtEveryJump) {
  SafetyStage stage({.force_cap = 4.0, .slew_cap = 1e6, .start_ramp = 0.5});
  for (int i = 1; i <= 500; ++i) {
    const double force = stage.apply({.force = {10, 0, 0}, .dt = 0.001}).x;
    ASSERT_NEAR(force, 4.0 * std::min(1.0, i * 0.002), 1e-9);
  }
  (void)stage.apply({.dt = 0.001, .cut = ForceCut::kJump});
  EXPECT_EQ(stage.apply({.force = {10, 0, 0}, .dt = 0.001}).x, 4.0);
  (void)stage.apply({.force = {kNan, 0, 0}, .dt = 0.001});
  EXPECT_NEAR(stage.apply({.force = {10, 0, 0}, .dt = 0.001}).x, 0.008, 1e-9);
}

/// Anything that a double can be, ordinary sizes most often.
double hostile(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  constexpr std::array kNasty{kNan,
                              kInf,
                              -kInf,
                              kLargest,
                              -kLargest,
                              kDenormal,
                              0.0,
                              -0.0,
                              1e300,
                              1e-300,
                              std::numeric_limits<double>::min()};
  switch (random() % 8) {
    case 0:
      return kNasty[random() % kNasty.size()];
    case 1:
      return unit(random) * std::exp2(static_cast<double>(random() % 2000) - 1000.0);
    default:
      return 6.0 * unit(random);
  }
}

TEST(SafetyStage, KeepsItsPromisesForAnyInput) {
  std::mt19937_64 random{11};
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const DeviceLimits limits{
      .force_cap = 3.0, .slew_cap = 150.0, .velocity_gate = 50.0, .stale_after = 0.1, .start_ramp = 0.05};
  SafetyStage stage(limits);
  Vec3 last{0.0};
  int at_cap = 0;
  int cut = 0;
  for (int i = 0; i < 400'000; ++i) {
    // Mostly an ordinary hand, so that forces have time to grow between the cuts.
    const bool calm = random() % 16 != 0;
    ForceRequest request{.dt = 0.001 * unit(random), .age = 0.1 * unit(random), .speed = 2.0 * unit(random)};
    request.force = calm ? Vec3{5.0, 5.0 * unit(random), unit(random) - 0.5}
                         : Vec3{hostile(random), hostile(random), hostile(random)};
    if (random() % 64 == 0) request.dt = hostile(random);
    if (random() % 128 == 0) request.age = hostile(random);
    if (random() % 256 == 0) request.speed = hostile(random) * 10.0;
    if (random() % 256 == 0) request.cut = ForceCut::kJump;
    if (random() % 512 == 0) stage.switch_off();
    if (random() % 64 == 0) stage.arm();
    const Vec3 force = stage.apply(request);
    ASSERT_TRUE(is_finite(force)) << i;
    ASSERT_LE(glm::length(force), limits.force_cap * (1.0 + kRounding)) << i;
    if (force != Vec3{0.0}) {
      const double most = limits.slew_cap * std::clamp(request.dt, 0.0, 0.020);
      // The cap applied after the slew moves the force by roundings of its size.
      ASSERT_LE(glm::distance(force, last), most * (1.0 + kRounding) + 1e-15 * limits.force_cap) << i;
      ASSERT_EQ(stage.cut(), ForceCut::kNone) << i;
    }
    at_cap += glm::length(force) > 0.99 * limits.force_cap ? 1 : 0;
    cut += stage.cut() != ForceCut::kNone ? 1 : 0;
    last = force;
  }
  EXPECT_GT(at_cap, 1000) << "the cap was not tried";
  EXPECT_GT(cut, 10'000) << "the cuts were not tried";
}

}  // namespace
}  // namespace palpate::test
