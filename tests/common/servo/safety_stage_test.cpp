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

/// How far `force` is from where the force before may fall to.
double rise(const Vec3& force, const Vec3& before) {
  const double square = glm::dot(before, before);
  const double lambda = square > 0.0 ? std::clamp(glm::dot(force, before) / square, 0.0, 1.0) : 0.0;
  return glm::distance(force, lambda * before);
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
      Case{{.force = pull, .dt = 0.001, .position = {0.51, 0, 0}}, ForceCut::kOutOfReach, false},
      Case{{.force = pull, .dt = 0.001, .position = {0, kNan, 0}}, ForceCut::kOutOfReach, false},
      Case{{.force = pull, .dt = 0.001, .cut = ForceCut::kJump}, ForceCut::kJump, false},
      Case{{.force = pull, .dt = 0.001, .cut = ForceCut::kChain}, ForceCut::kChain, true},
  };
  for (const Case& c : cases) {
    SafetyStage stage =
        settled({.slew_cap = 100.0, .reach_lower = Vec3{-0.5}, .reach_upper = Vec3{0.5}}, pull);
    EXPECT_EQ(stage.apply(c.request), Vec3(0.0)) << name_of(c.cut);
    EXPECT_EQ(stage.cut(), c.cut) << name_of(c.cut);
    EXPECT_EQ(is_fault(stage.cut()), c.fault) << name_of(c.cut);
    EXPECT_NEAR(stage.apply({.force = pull, .dt = 0.001}).x, 0.1, 1e-15) << name_of(c.cut);
  }
}

TEST(SafetyStage, FadesOutOnStaleSamplesAndGrowsFromThereWhenTheyAreFreshAgain) {
  SafetyStage stage = settled({.slew_cap = 100.0, .fade_time = 0.050}, {0, 1, 0});
  for (int i = 1; i <= 60; ++i) {
    // What is asked for no longer counts, nor does a first sample that is not old but has no age at all.
    const double age = i == 1 ? kNan : 0.1 + 0.001 * i;
    const Vec3 force = stage.apply({.force = {3, 0, 0}, .dt = 0.001, .age = age});
    ASSERT_NEAR(glm::distance(force, Vec3(0, std::max(0.0, 1.0 - 0.02 * i), 0)), 0.0, 1e-13) << i;
    ASSERT_EQ(stage.cut(), ForceCut::kStale);
  }
  EXPECT_NEAR(stage.apply({.force = {0, 1, 0}, .dt = 0.001}).y, 0.1, 1e-15);
  for (int i = 0; i < 8; ++i) (void)stage.apply({.force = {0, 1, 0}, .dt = 0.001});
  const Vec3 half = stage.apply({.force = {0, 1, 0}, .dt = 0.025, .age = 1.0});
  EXPECT_NEAR(half.y, 0.45, 1e-13) << "0.9 after half of another fade";
  EXPECT_NEAR(stage.apply({.force = {0, 1, 0}, .dt = 0.001}).y, 0.55, 1e-13) << "no step back";
}

TEST(SafetyStage, FadesOutWhenTheEnablingButtonIsReleasedAndStartsAnewWhenItIsPressed) {
  const DeviceLimits limits{.slew_cap = 1e4, .start_ramp = 0.1, .fade_time = 0.050, .enabling_button = 1};
  SafetyStage stage(limits);
  const auto step = [&](std::uint32_t buttons, double age = 0.0) {
    return stage.apply({.force = {5, 0, 0}, .dt = 0.001, .age = age, .buttons = buttons}).x;
  };
  EXPECT_EQ(step(0b01), 0.0) << "never pressed";
  EXPECT_EQ(stage.cut(), ForceCut::kReleased);
  EXPECT_FALSE(is_fault(stage.cut()));
  for (int i = 1; i <= 200; ++i) ASSERT_NEAR(step(0b10), 4.0 * std::min(1.0, 0.01 * i), 1e-9);
  for (int i = 1; i <= 50; ++i) ASSERT_NEAR(step(0b01), 4.0 * (1.0 - 0.02 * i), 1e-12);
  EXPECT_EQ(step(0b00), 0.0);
  EXPECT_NEAR(step(0b10), 0.04, 1e-9) << "from the start of the ramp";
  for (int i = 0; i < 200; ++i) (void)step(0b10, 0.99 * kEnablingStale);
  EXPECT_LT(step(0b10, 1.01 * kEnablingStale), 4.0)
      << "a button that is as old as that may have been released";
}

TEST(SafetyStage, NothingRevivesAForceThatIsFadingOut) {
  const DeviceLimits limits{.fade_time = 0.050, .enabling_button = 0};
  SafetyStage stage(limits);
  for (int i = 0; i < 100; ++i) (void)stage.apply({.force = {1, 0, 0}, .dt = 0.001, .buttons = 1});
  EXPECT_NEAR(stage.apply({.force = {1, 0, 0}, .dt = 0.001}).x, 0.98, 1e-12);
  EXPECT_EQ(stage.apply({.force = {1, 0, 0}, .dt = kNan}), Vec3(0.0));
  EXPECT_EQ(stage.apply({.force = {1, 0, 0}, .dt = 0.001}), Vec3(0.0));
  EXPECT_EQ(stage.apply({.force = {1, 0, 0}, .dt = 0.001, .age = 9.0}), Vec3(0.0));
}

TEST(SafetyStage, NothingFadesOutsideOfTheReach) {
  SafetyStage stage =
      settled({.fade_time = 0.050, .reach_upper = Vec3{0.5}, .latch_faults = true}, {1, 0, 0});
  EXPECT_NEAR(stage.apply({.force = {1, 0, 0}, .dt = 0.001, .age = 9.0}).x, 0.98, 1e-12);
  EXPECT_EQ(stage.apply({.force = {1, 0, 0}, .dt = 0.001, .position = {0.6, 0, 0}}), Vec3(0.0));
  EXPECT_EQ(stage.cut(), ForceCut::kStale) << "what was wrong first is told";
  EXPECT_EQ(stage.apply({.force = {1, 0, 0}, .dt = 0.001}), Vec3(0.0));
}

TEST(SafetyStage, LatchesFaultsWhereTheDeviceAsksForIt) {
  for (const bool latch : {false, true}) {
    SafetyStage stage = settled({.latch_faults = latch}, {1, 0, 0});
    EXPECT_EQ(stage.apply({.force = {kInf, 0, 0}, .dt = 0.001}), Vec3(0.0));
    EXPECT_EQ(stage.armed(), !latch);
    (void)stage.apply({.force = {1, 0, 0}, .dt = -1.0});
    const Vec3 after = stage.apply({.force = {1, 0, 0}, .dt = 0.001});
    EXPECT_EQ(after.x > 0.0, !latch);
    EXPECT_EQ(stage.cut(), latch ? ForceCut::kNotFinite : ForceCut::kNone) << "the first one is told";
    stage.arm();
    EXPECT_GT(stage.apply({.force = {1, 0, 0}, .dt = 0.001}).x, 0.0);
  }
}

TEST(SafetyStage, PushesBackFromTheEdgeAgainstAPullOutOfIt) {
  const DeviceLimits limits{
      .force_cap = 4.0, .slew_cap = 1e6, .reach_lower = Vec3{-0.1}, .reach_upper = Vec3{0.1}};
  SafetyStage stage(limits);
  const Vec3 inside = stage.apply({.force = {0, 1, 0}, .dt = 0.001, .position = {0.098, 0, 0}});
  EXPECT_NEAR(glm::distance(inside, Vec3(-0.6, 1, 0)), 0.0, 1e-12) << "200 N/m, 3 mm into the margin";
  const Vec3 pulled = stage.apply({.force = {900, 0, 0}, .dt = 0.001, .position = {0.1, 0, 0}});
  EXPECT_NEAR(pulled.x, 3.0, 1e-12) << "the cap, less the push";
  EXPECT_EQ(stage.apply({.force = {900, 0, 0}, .dt = 0.001, .position = {0.1001, 0, 0}}), Vec3(0.0));
}

TEST(SafetyStage, ShowsItsPeakForAWhileAndThenWhatMayLast) {
  const DeviceLimits limits{.force_cap = 8.0, .slew_cap = 1e6, .continuous_cap = 2.0, .heating_time = 1.0};
  SafetyStage stage(limits);
  double heat = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    const double force = stage.apply({.force = {100, 0, 0}, .dt = 0.001}).x;
    if (i == 0) {
      EXPECT_EQ(force, 8.0);
    }
    ASSERT_GE(force, 2.0);
    heat += (force * force - heat) * 0.001;
    ASSERT_LE(heat, 4.0 * 1.001) << i;
  }
  EXPECT_NEAR(stage.apply({.force = {100, 0, 0}, .dt = 0.001}).x, 2.0, 1e-6);
  for (int i = 0; i < 10'000; ++i) (void)stage.apply({.dt = 0.001, .cut = ForceCut::kNoHand});
  EXPECT_GT(stage.apply({.force = {100, 0, 0}, .dt = 0.001}).x, 7.9) << "cold again";
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
  stage.arm();
  (void)stage.apply({.force = {1, 0, 0}, .dt = 0.001, .speed = 2.0, .cut = ForceCut::kJump});
  EXPECT_EQ(stage.cut(), ForceCut::kTooFast) << "whatever else happens in that step";
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
  const DeviceLimits limits{.force_cap = 3.0,
                            .slew_cap = 150.0,
                            .velocity_gate = 50.0,
                            .stale_after = 0.1,
                            .start_ramp = 0.05,
                            .fade_time = 0.01,
                            .continuous_cap = 2.9,
                            .reach_lower = Vec3{-0.1},
                            .reach_upper = Vec3{0.1},
                            .enabling_button = 2,
                            .latch_faults = true};
  SafetyStage stage(limits);
  Vec3 last{0.0};
  int at_cap = 0;
  int cut = 0;
  int faded = 0;
  for (int i = 0; i < 400'000; ++i) {
    // Mostly an ordinary hand, so that forces have time to grow between the cuts.
    const bool calm = random() % 16 != 0;
    ForceRequest request{
        .dt = 0.001 * unit(random), .age = kEnablingStale * unit(random), .speed = 2.0 * unit(random)};
    request.force = calm ? Vec3{5.0, 5.0 * unit(random), unit(random) - 0.5}
                         : Vec3{hostile(random), hostile(random), hostile(random)};
    if (random() % 64 == 0) request.dt = hostile(random);
    if (random() % 128 == 0) request.age = hostile(random);
    if (random() % 256 == 0) request.speed = hostile(random) * 10.0;
    request.position = 0.09 * Vec3{unit(random), unit(random), unit(random)};
    request.buttons = random() % 64 == 0 ? 0U : 4U;
    if (random() % 256 == 0) request.position.y = hostile(random);
    if (random() % 256 == 0) request.cut = static_cast<ForceCut>(random() % kForceCutCount);
    if (random() % 512 == 0) stage.switch_off();
    if (random() % 64 == 0) stage.arm();
    const Vec3 force = stage.apply(request);
    ASSERT_TRUE(is_finite(force)) << i;
    ASSERT_LE(glm::length(force), limits.force_cap * (1.0 + kRounding)) << i;
    const double most = limits.slew_cap * std::clamp(std::isnan(request.dt) ? 0.0 : request.dt, 0.0, 0.020);
    // The cap applied after the slew moves the force by roundings of its size.
    ASSERT_LE(rise(force, last), most * (1.0 + kRounding) + 1e-15 * limits.force_cap) << i;
    ASSERT_TRUE(force == Vec3{0.0} || stage.cut() == ForceCut::kNone || fades_out(stage.cut())) << i;
    faded += force != Vec3{0.0} && stage.cut() != ForceCut::kNone ? 1 : 0;
    at_cap += glm::length(force) > 0.9 * limits.force_cap ? 1 : 0;
    cut += stage.cut() != ForceCut::kNone ? 1 : 0;
    last = force;
  }
  EXPECT_GT(at_cap, 1000) << "the cap was not tried";
  EXPECT_GT(cut, 10'000) << "the cuts were not tried";
  EXPECT_GT(faded, 1000) << "no fade was tried";
}

}  // namespace
}  // namespace palpate::test
