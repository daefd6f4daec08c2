// The rules along the axes of a frame: worked by hand, jointly, pressed against, and faded.

#include "common/haptics/axis_rule.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/haptics/motion_rule.h"

namespace palpate {
namespace {

constexpr AxisHold kFree{}, kFixed{.rule = AxisRule::kFixed};

AxisHold drag_hold(double tau) { return {.rule = AxisRule::kDrag, .tau = tau}; }
AxisHold snap_hold(double tau) { return {.rule = AxisRule::kSnap, .tau = tau}; }
AxisHold wall_hold(double tau) { return {.rule = AxisRule::kUnilateral, .tau = tau}; }

Vec3 moved(const Vec3& dx, const AxisHolds& holds, double friction = 0.0) {
  return move_by_rules(dx, holds, friction).moved;
}

TEST(AxisRule, HasANameThatReadsBack) {
  for (int r = 0; r < kAxisRuleCount; ++r) {
    const auto rule = static_cast<AxisRule>(r);
    EXPECT_EQ(axis_rule_of(name_of(rule)), rule);
  }
  EXPECT_EQ(axis_rule_of("loose"), std::nullopt);
}

TEST(AxisRule, OnePointOneLineOnePlane) {
  const Vec3 dx{1.0, -2.0, 3.0};
  EXPECT_EQ(moved(dx, {kFixed, kFixed, kFixed}), Vec3{0.0}) << "point";
  EXPECT_EQ(moved(dx, {kFree, kFixed, kFixed}), Vec3(1.0, 0.0, 0.0)) << "line";
  EXPECT_EQ(moved(dx, {kFixed, kFree, kFree}), Vec3(0.0, -2.0, 3.0)) << "plane";
  EXPECT_EQ(moved(dx, {kFree, kFree, kFree}), dx) << "nothing";
}

TEST(AxisRule, EachAxisByItsOwnRule) {
  EXPECT_EQ(moved({-3.0, 2.5, 5.0}, {wall_hold(1.0), snap_hold(1.0), kFree}), Vec3(-2.0, 2.0, 5.0));
  EXPECT_EQ(moved({3.0, 0.5, 5.0}, {wall_hold(1.0), snap_hold(1.0), kFixed}), Vec3(3.0, 0.0, 0.0));
  const Vec3 dragged = moved({-0.5, 3.0, 4.0}, {wall_hold(1.0), drag_hold(1.0), drag_hold(1.0)});
  EXPECT_LE(glm::distance(dragged, Vec3(0.0, 2.4, 3.2)), 1e-14) << "jointly: four of five, and no box";
}

// Pressed 2 mm into the wall, friction 0.5 adds 1 mm to both thresholds of 1 mm.
TEST(AxisRule, FrictionGrowsWithThePenetration) {
  const AxisHolds holds{wall_hold(0.010), drag_hold(0.001), drag_hold(0.001)};
  EXPECT_LE(glm::distance(moved({-0.002, 0.0, 0.005}, holds), Vec3(0.0, 0.0, 0.004)), 1e-15);
  EXPECT_LE(glm::distance(moved({-0.002, 0.0, 0.005}, holds, 0.5), Vec3(0.0, 0.0, 0.003)), 1e-15);
  EXPECT_LE(glm::distance(moved({0.002, 0.0, 0.005}, holds, 0.5), Vec3(0.002, 0.0, 0.004)), 1e-15)
      << "off the wall nothing presses";
  EXPECT_LE(glm::distance(moved({0.002, 0.0, 0.005}, {kFixed, snap_hold(0.001), snap_hold(0.001)}, 0.5),
                          Vec3(0.0, 0.0, 0.004)),
            1e-15)
      << "two detents of 2 mm";
}

AxisHold any_hold(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit;
  return {
      .rule = static_cast<AxisRule>(random() % kAxisRuleCount), .tau = unit(random), .kappa = unit(random)};
}

// What is left changes by no more than the probe: allowed sets are convex, and the motion is the least. Teeth
// are left out.
TEST(AxisRule, WhatIsLeftFollowsTheProbeContinuously) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 20'000; ++n) {
    AxisHolds holds{any_hold(random), any_hold(random), any_hold(random)};
    for (AxisHold& hold : holds) {
      if (hold.rule == AxisRule::kSnap) hold.rule = AxisRule::kDrag;
    }
    const Vec3 one{normal(random), normal(random), normal(random)};
    const Vec3 other = one + 0.1 * Vec3{normal(random), normal(random), normal(random)};
    const Vec3 change = (one - moved(one, holds)) - (other - moved(other, holds));
    EXPECT_LE(glm::length(change), glm::distance(one, other) * (1.0 + 1e-9));
  }
}

TEST(AxisRule, KnowsItsJacobian) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  constexpr double kAside = 1e-7;
  int kinks = 0;
  for (int n = 0; n < 3000; ++n) {
    const AxisHolds holds{any_hold(random), any_hold(random), any_hold(random)};
    const Vec3 dx{normal(random), normal(random), normal(random)};
    const Mat3 jacobian = move_by_rules(dx, holds, 0.0).jacobian;
    double worst = 0.0;
    for (int a = 0; a < 3; ++a) {
      Vec3 aside{0.0};
      aside[a] = kAside;
      const Vec3 slope = (moved(dx + aside, holds) - moved(dx - aside, holds)) / (2.0 * kAside);
      // Teeth leave J at the direction towards the probe, which turns with it: stated as fixed.
      const bool detents = std::any_of(holds.begin(), holds.end(),
                                       [](const AxisHold& hold) { return hold.rule == AxisRule::kSnap; });
      if (!detents) worst = std::max(worst, glm::distance(jacobian[a], slope));
    }
    kinks += worst > 1e-5;
  }
  EXPECT_LE(kinks, 3) << "but for draws right at a kink";
}

double leap(const AxisHolds& a, const AxisHolds& b, const Vec3& dx) {
  return glm::distance(moved(dx, a), moved(dx, b));
}

// From certain to undefined in small steps: no step moves the proxy by more than its share. At 0 nothing
// tells the axes apart.
TEST(AxisRule, FadesContinuouslyToAxesThatAreAlike) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 300; ++n) {
    AxisHolds holds{any_hold(random), any_hold(random), any_hold(random)};
    for (AxisHold& hold : holds) {
      hold.tau *= 0.02;
      if (hold.rule == AxisRule::kSnap) hold.rule = AxisRule::kFixed;  // detents leap by themselves
    }
    for (const int first : {0, 1}) {
      const Vec3 dx = 0.02 * Vec3{normal(random), normal(random), normal(random)};
      constexpr int kSteps = 2000;
      AxisHolds last = holds;
      for (int k = kSteps; k >= 0; --k) {
        AxisHolds now = holds;
        make_alike(now, first, 1.0 * k / kSteps);
        ASSERT_LE(leap(last, now, dx), 2.0 / kSteps) << "at " << k;
        last = now;
      }
      if (first > 0) continue;
      // Turned about any axis: the same motion.
      const Vec3 t = glm::normalize(Vec3{normal(random), normal(random), normal(random)});
      const Vec3 u = glm::normalize(glm::cross(t, Vec3{normal(random), normal(random), normal(random)}));
      const Mat3 axes{t, u, glm::cross(t, u)};
      ASSERT_LE(glm::distance(axes * moved(dx * axes, last), moved(dx, last)), 1e-12);
      EXPECT_EQ(last[0].kappa, last[1].kappa);
      EXPECT_EQ(last[1].kappa, last[2].kappa);
    }
  }
}

TEST(AxisRule, KeepsWhatIsAlikeWhereTheFrameIsUndefined) {
  AxisHolds point{drag_hold(0.004), drag_hold(0.004), drag_hold(0.004)};
  make_alike(point, 0, 0.0);
  EXPECT_LE(glm::distance(moved({0.0, 0.0, 0.005}, point), Vec3(0.0, 0.0, 0.001)), 1e-15);
  AxisHolds held{kFixed, kFixed, kFixed};
  make_alike(held, 0, 0.25);
  EXPECT_EQ(moved(Vec3{1.0}, held), Vec3{0.0}) << "a point needs no axes";
  AxisHolds line{kFree, kFixed, kFixed};
  make_alike(line, 0, 0.0);
  EXPECT_EQ(moved(Vec3{1.0}, line), Vec3{1.0}) << "a line without a direction is free";
  AxisHolds mixed{snap_hold(0.004), drag_hold(0.004), drag_hold(0.004)};
  make_alike(mixed, 0, 0.0);
  EXPECT_EQ(moved(Vec3{1.0}, mixed), Vec3{1.0}) << "detents along no direction are none";
  AxisHolds gone{wall_hold(0.01), kFixed, drag_hold(0.004)};
  let_go(gone, 0.0);
  EXPECT_EQ(moved(-Vec3{1.0}, gone), -Vec3{1.0});
}

}  // namespace
}  // namespace palpate
