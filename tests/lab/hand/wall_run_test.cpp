// The bench of virtual walls against theory: it must see instability where theory puts it, or what it says of
// controllers and hands means nothing.

#include "lab/hand/wall/wall_run.h"

#include <cmath>

#include <gtest/gtest.h>

#include "lab/hand/wall/energy_cycle.h"
#include "tests/support/stability_limit.h"

namespace palpate::test {
namespace {

/// A mass and a damper, pushed from the surface of the wall: nothing but the hold can make it swing.
WallCase plain(double mass, double damping, double rate) {
  WallCase wall{.device = find_profile("ideal"), .rate = rate, .seconds = 8.0};
  wall.device.mass = mass;
  wall.device.damping = damping;
  return wall;
}

double bound_of(const WallCase& wall) { return 2.0 * wall.device.damping * wall.rate; }

TEST(WallRun, BeginsToSwingAtTheBoundOfPassivity) {
  for (const auto& [mass, damping, rate] :
       {std::tuple{0.1, 2.0, 1000.0}, {0.1, 2.0, 500.0}, {0.1, 2.0, 4000.0}, {0.3, 3.0, 1000.0}}) {
    const WallCase wall = plain(mass, damping, rate);
    const double found = largest_stable_stiffness(wall);
    EXPECT_NEAR(found, bound_of(wall), 0.05 * bound_of(wall)) << mass << " " << damping << " " << rate;
    EXPECT_NEAR(found, linear_stability_limit(mass, damping, rate), 0.02 * bound_of(wall));
  }
}

// Where the damping is heavy, b T / m = 1, stability and passivity part; the bench follows the former.
TEST(WallRun, FollowsTheSampledLoopWhereItLeavesThatBound) {
  const WallCase wall = plain(0.02, 10.0, 500.0);
  const double limit = linear_stability_limit(0.02, 10.0, 500.0);
  EXPECT_GT(limit, 1.15 * bound_of(wall));
  EXPECT_NEAR(largest_stable_stiffness(wall), limit, 0.02 * limit);
}

TEST(WallRun, KnowsTheLimitOfTheSampledLoop) {
  // b T / m = 0.02: 1 + 0.02 / 6 of the bound, to the next order.
  EXPECT_NEAR(linear_stability_limit(0.1, 2.0, 1000.0) / 4000.0, 1.0 + 0.02 / 6.0, 2e-5);
}

TEST(WallRun, SwingsEarlierWithDelay) {
  for (const double delay : {0.0005, 0.002, 0.0075}) {
    for (const bool sensor : {false, true}) {
      WallCase wall = plain(0.1, 2.0, 1000.0);
      (sensor ? wall.device.sensor_delay : wall.device.actuator_delay) = delay;
      const double bound = stiffness_bound(loop_of(wall), 0.0).stiffness;
      EXPECT_NEAR(bound, 2.0 / (0.0005 + delay), 1e-9);
      EXPECT_NEAR(largest_stable_stiffness(wall), bound, 0.05 * bound) << delay;
    }
  }
}

TEST(WallRun, IsStableFurtherInAHand) {
  WallCase wall = plain(0.1, 2.0, 1000.0);
  wall.hand = kRelaxedHand;
  const double relaxed = largest_stable_stiffness(wall);
  wall.hand = kFirmHand;
  const double firm = largest_stable_stiffness(wall);
  // To first order the dampings add: 2 (b + b_h) / T, and the hand's own spring takes none of it away.
  EXPECT_NEAR(relaxed, 8000.0, 0.05 * 8000.0);
  EXPECT_NEAR(firm, 20'000.0, 0.05 * 20'000.0);
}

TEST(WallRun, SettlesToALimitCycleBeyondTheBoundAndNotBelow) {
  WallCase wall = plain(0.1, 2.0, 1000.0);
  wall.stiffness = 0.9 * bound_of(wall);
  EXPECT_FALSE(run_wall(wall).swing.sustained);
  wall.stiffness = 2.0 * bound_of(wall);
  const WallRun run = run_wall(wall);
  EXPECT_TRUE(run.swing.sustained);
  EXPECT_GT(run.swing.amplitude, 1.0 / wall.stiffness) << "it leaves the wall";
  // Slower than the mass on the spring alone, for the time that it flies.
  EXPECT_LT(run.swing.frequency, std::sqrt(wall.stiffness / 0.1) / 6.283);
  EXPECT_GT(run.energy.motors, 0.0);
}

// Ten times the bound: the wall alone throws the arm about; the controller holds it.
TEST(WallRun, StaysWithinTwoMillimetresUnderTheController) {
  for (const double gap : {0.0, 1e-3}) {
    WallCase wall = plain(0.1, 2.0, 1000.0);
    wall.gap = gap;
    wall.stiffness = 10.0 * bound_of(wall);
    const WallRun loose = run_wall(wall);
    EXPECT_TRUE(loose.swing.sustained);
    EXPECT_GT(loose.farthest, 5e-3);
    wall.controlled = true;
    const WallRun held = run_wall(wall);
    EXPECT_LT(std::max(held.deepest, held.farthest), 2e-3);
    EXPECT_FALSE(held.saturated);
    EXPECT_LT(held.force, 0.5 * wall.device.peak_force);
    EXPECT_FALSE(held.swing.sustained);
    EXPECT_LT(held.energy.motors, 0.02 * loose.energy.motors);
  }
}

TEST(WallRun, LeavesAWallBelowTheBoundMuchAsItIs) {
  WallCase wall = plain(0.1, 2.0, 1000.0);
  wall.stiffness = 0.25 * bound_of(wall);
  const WallRun loose = run_wall(wall);
  wall.controlled = true;
  const WallRun held = run_wall(wall);
  EXPECT_EQ(held.deepest, loose.deepest) << "the way in takes energy: nothing to be damped";
  EXPECT_EQ(held.force, loose.force);
}

// Friction swallows small swings, encoder steps feed them: devices far beyond their bound are quiet in
// practice.
TEST(WallRun, IsQuietedByFriction) {
  WallCase wall{.device = find_profile("premium3"), .push = 2.0, .gap = 2e-3};
  EXPECT_NEAR(stiffness_bound(loop_of(wall), 0.0).stiffness, 200.0, 1e-9);
  EXPECT_GT(largest_stable_stiffness(wall), 10.0 * 200.0);
  wall.device.friction = 0.0;
  wall.device.encoder_step = 0.0;
  wall.seconds = 20.0;
  EXPECT_NEAR(largest_stable_stiffness(wall), 200.0, 20.0);
}

TEST(EnergyCycle, LeaksWhatTheoryAndTheObserverSay) {
  for (const double rate : {500.0, 1000.0, 4000.0}) {
    WallCase wall = plain(0.1, 2.0, rate);
    wall.stiffness = 3000.0;
    const EnergyCycle cycle = run_energy_cycle(wall);
    const double leak = wall.stiffness * kCycleSpeed / rate * kCycleDepth;
    EXPECT_NEAR(cycle.leaked, leak, 1e-9 * leak);
    EXPECT_NEAR(cycle.lost, 2.0 * 2.0 * kCycleSpeed * kCycleDepth, 1e-15);
    // Delay adds its own: the force is late by d = v t_d both ways, and by less next to the turn and the
    // surface, to first order in what it is late by over the depth.
    wall.device.actuator_delay = 0.0013;
    const double d = kCycleSpeed * 0.0013, late = 2.0 * wall.stiffness * d * kCycleDepth;
    const double least = late * (1.0 - (d + kCycleSpeed / rate) / kCycleDepth);
    EXPECT_LT(run_energy_cycle(wall).leaked, leak + late);
    EXPECT_GT(run_energy_cycle(wall).leaked, leak + least);
  }
}

TEST(EnergyCycle, ChangesItsSignAtTheBoundOfPassivity) {
  for (const auto& [mass, damping, rate] :
       {std::tuple{0.1, 2.0, 1000.0}, {0.1, 0.1, 1000.0}, {0.5, 2.0, 250.0}, {0.1, 5.0, 8000.0}}) {
    const WallCase wall = plain(mass, damping, rate);
    EXPECT_NEAR(energy_free_stiffness(wall), bound_of(wall), 0.01 * bound_of(wall)) << damping << " " << rate;
  }
}

TEST(EnergyCycle, GivesNothingUnderTheController) {
  WallCase wall = plain(0.1, 2.0, 1000.0);
  wall.stiffness = 3.0 * bound_of(wall);
  EXPECT_GT(run_energy_cycle(wall).to_hand, 0.0);
  wall.controlled = true;
  EXPECT_LT(run_energy_cycle(wall).to_hand, 0.0);
}

}  // namespace
}  // namespace palpate::test
