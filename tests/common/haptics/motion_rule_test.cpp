// The motion rules against force profiles worked out by hand (figure 6.3) and against what defines them.

#include "common/haptics/motion_rule.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(Drag, FollowsAtTheThreshold) {
  EXPECT_EQ(drag(0.5, 1.0), 0.0);
  EXPECT_EQ(drag(1.0, 1.0), 0.0);
  EXPECT_EQ(drag(3.0, 1.0), 2.0);
  EXPECT_EQ(drag(-3.0, 1.0), -2.0);
  EXPECT_EQ(drag(-3.0, 0.0), -3.0) << "eq. 6.6: no threshold, no drag";
  EXPECT_EQ(drag(1e300, HUGE_VAL), 0.0);
}

TEST(Unilateral, IsFreeOutward) {
  EXPECT_EQ(unilateral(2.0, 1.0), 2.0);
  EXPECT_EQ(unilateral(-0.5, 1.0), 0.0);
  EXPECT_EQ(unilateral(-2.5, 1.0), -1.5);
}

TEST(SnapDrag, JumpsByWholeDetentsToWithinOneOfTheProbe) {
  EXPECT_EQ(snap_drag(1.0, 1.0), 0.0);
  EXPECT_EQ(snap_drag(1.25, 1.0), 1.0) << "eq. 6.8";
  EXPECT_EQ(snap_drag(-1.25, 1.0), -1.0);
  EXPECT_EQ(snap_drag(7.5, 1.0), 7.0) << "a fast probe is caught up with";
  EXPECT_EQ(snap_drag(0.3, 0.0), 0.3);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> any(-100.0, 100.0);
  for (int n = 0; n < 10'000; ++n) {
    const double dx = any(random), tau = std::abs(any(random)) + 1e-3;
    const double moved = snap_drag(dx, tau);
    EXPECT_LE(std::abs(dx - moved), tau * (1.0 + 1e-12));
    EXPECT_NEAR(moved / tau, std::round(moved / tau), 1e-9);
  }
}

// A probe that stands at a whole number of detents, to rounding: what is left is one tooth, to rounding, and no
// second jump follows.
TEST(SnapDrag, MovesNothingASecondTimeAtWholeTeeth) {
  constexpr double kTau = 0.1;
  for (int k = 2; k < 1000; ++k) {
    const double dx = k * kTau, left = dx - snap_drag(dx, kTau);
    EXPECT_EQ(snap_drag(left, kTau), 0.0) << k;
    const Vec3 along = dx * Vec3{0.6, 0.0, 0.8};
    EXPECT_EQ(snap_jointly(along - snap_jointly(along, Vec3{kTau}), Vec3{kTau}), Vec3{0.0}) << k;
  }
}

// Figure 6.3 (a), hand computed: tau = 2, the probe goes out and back.
TEST(MotionRule, UnilateralDrag) {
  const double probe[] = {1, 0, -1, -2, -3, -4, -3, -2, -1, 0};
  const double proxy[] = {1, 1, 1, 0, -1, -2, -2, -2, -1, 0};
  double p = 1.0;
  for (int k = 0; k < 10; ++k) {
    p += unilateral(probe[k] - p, 2.0);
    EXPECT_EQ(p, proxy[k]) << "step " << k;
  }
}

// Figure 6.3 (b), tau = 2.
TEST(MotionRule, SnapDrag) {
  const double probe[] = {0, 1, 2, 2.5, 3, 4, 4.5, 3, 2, 1.5};
  const double proxy[] = {0, 0, 0, 2, 2, 2, 4, 4, 4, 2};
  double p = 0.0;
  for (int k = 0; k < 10; ++k) {
    p += snap_drag(probe[k] - p, 2.0);
    EXPECT_EQ(p, proxy[k]) << "step " << k;
  }
}

TEST(JointDrag, EqualsDragOnOneAxis) {
  EXPECT_NEAR(drag_jointly({3.0, 0.0, 0.0}, Vec3{1.0}).moved.x, drag(3.0, 1.0), 1e-14);
  EXPECT_EQ(drag_jointly({0.5, 0.5, 0.5}, Vec3{1.0}).moved, Vec3{0.0});
  const Vec3 moved = drag_jointly({3.0, 2.0, -1.0}, {HUGE_VAL, 0.0, 0.25}).moved;
  EXPECT_EQ(moved.x, 0.0) << "fixed";
  EXPECT_EQ(moved.y, 2.0) << "free";
  EXPECT_NEAR(moved.z, -0.75, 1e-14);
}

TEST(JointDrag, IsTheSameForEveryFrameWhereThresholdsAreEqual) {
  const Vec3 dx{1.0, -2.0, 0.5};
  const Vec3 moved = drag_jointly(dx, Vec3{0.75}).moved;
  EXPECT_NEAR(glm::length(dx - moved), 0.75, 1e-14);
  EXPECT_NEAR(glm::length(glm::cross(moved, dx)), 0.0, 1e-14);
}

// The least displacement that satisfies the ellipsoid: what is left is on it, and the displacement is normal
// to it (the condition of Lagrange), for axes of any ratio.
TEST(JointDrag, MovesTheLeastDistance) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> exponent(-3.0, 1.0);
  for (int n = 0; n < 10'000; ++n) {
    const Vec3 dx{normal(random), normal(random), normal(random)};
    const Vec3 tau{std::pow(10.0, exponent(random)), std::pow(10.0, exponent(random)),
                   std::pow(10.0, exponent(random))};
    const Vec3 moved = drag_jointly(dx, tau).moved, left = dx - moved;
    const double level = glm::length(left / tau);
    if (glm::length(dx / tau) <= 1.0) {
      EXPECT_EQ(moved, Vec3{0.0});
      continue;
    }
    EXPECT_NEAR(level, 1.0, 1e-9);
    const Vec3 outward = left / (tau * tau);
    const double sine = glm::length(glm::cross(moved, outward)) / (glm::length(moved) * glm::length(outward));
    if (glm::length(moved) > 1e-6 * glm::length(dx)) {
      EXPECT_LE(sine, 1e-6) << dx.x << ' ' << dx.y << ' ' << dx.z << " tau " << tau.x << ' ' << tau.y << ' '
                            << tau.z;
    }
  }
}

// Central differences of the motion itself, inside, outside, and with free and fixed axes among them.
TEST(JointDrag, KnowsItsJacobian) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> exponent(-1.0, 1.0);
  constexpr double kAside = 1e-6;
  for (int n = 0; n < 2000; ++n) {
    const Vec3 dx{normal(random), normal(random), normal(random)};
    Vec3 tau{0.0};
    for (int a = 0; a < 3; ++a) {
      const int kind = static_cast<int>(random() % 6);
      tau[a] = kind == 0 ? 0.0 : kind == 1 ? HUGE_VAL : std::pow(10.0, exponent(random));
    }
    double level = 0.0;
    for (int a = 0; a < 3; ++a) level += tau[a] > 0.0 ? dx[a] * dx[a] / (tau[a] * tau[a]) : 0.0;
    if (std::abs(level - 1.0) < 1e-3) continue;  // the corner between both
    const Mat3 jacobian = drag_jointly(dx, tau).jacobian;
    for (int a = 0; a < 3; ++a) {
      Vec3 aside{0.0};
      aside[a] = kAside;
      const Vec3 slope =
          (drag_jointly(dx + aside, tau).moved - drag_jointly(dx - aside, tau).moved) / (2.0 * kAside);
      EXPECT_LE(glm::distance(jacobian[a], slope), 1e-7) << tau.x << ' ' << tau.y << ' ' << tau.z;
    }
  }
  EXPECT_EQ(drag_jointly(Vec3{0.0}, {0.0, 1.0, HUGE_VAL}).jacobian[0], Vec3(1.0, 0.0, 0.0))
      << "at rest a free axis is free";
}

TEST(JointDrag, MovesNothingASecondTime) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> exponent(-3.0, 1.0);
  for (int n = 0; n < 10'000; ++n) {
    const Vec3 dx{normal(random), normal(random), normal(random)};
    const Vec3 tau{std::pow(10.0, exponent(random)), std::pow(10.0, exponent(random)),
                   std::pow(10.0, exponent(random))};
    const Vec3 left = dx - drag_jointly(dx, tau).moved;
    EXPECT_EQ(drag_jointly(left, tau).moved, Vec3{0.0});
    const Vec3 snapped = dx - snap_jointly(dx, tau);
    EXPECT_EQ(snap_jointly(snapped, tau), Vec3{0.0});
    EXPECT_LE(glm::length(snapped / tau), 1.0 + 1e-12);
  }
}

// On one axis the rule of eq. 6.8; on several by whole detents towards the probe, whatever the frame.
TEST(JointSnap, GoesByWholeDetentsTowardsTheProbe) {
  EXPECT_EQ(snap_jointly({2.5, 0.0, 0.0}, Vec3{1.0}), Vec3(snap_drag(2.5, 1.0), 0.0, 0.0));
  EXPECT_EQ(snap_jointly({0.6, 0.6, 0.5}, Vec3{1.0}), Vec3{0.0});
  EXPECT_EQ(snap_jointly({9.0, 2.5, 3.0}, {HUGE_VAL, 1.0, 0.0}), Vec3(0.0, 2.0, 3.0)) << "fixed, snap, free";
  const Vec3 dx{3.0, -4.0, 12.0};  // 13 long
  const Vec3 moved = snap_jointly(dx, Vec3{2.0});
  EXPECT_NEAR(glm::length(moved), 12.0, 1e-12) << "six detents of the six and a half";
  EXPECT_NEAR(glm::length(glm::cross(moved, dx)), 0.0, 1e-12);
  EXPECT_EQ(snap_jointly(Vec3{1e300}, Vec3{1e-300}), Vec3{1e300}) << "beyond counting";
}

// A hand that drags its proxy along is hardly outside, again and again: what it costs then must not grow with
// the digits that the multiplier has lost.
TEST(JointDrag, TakesFewStepsHoweverLittleTheProbeIsOutside) {
  constexpr int kFew = 12;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> exponent(-1.0, 1.0), digits(0.0, 11.0);
  int most = 0;
  for (int n = 0; n < 20'000; ++n) {
    const Vec3 tau{std::pow(10.0, exponent(random)), std::pow(10.0, exponent(random)),
                   std::pow(10.0, exponent(random))};
    const Vec3 around = glm::normalize(Vec3{normal(random), normal(random), normal(random)}) * tau;
    const JointDrag drag = drag_jointly(around * (1.0 + std::pow(10.0, -digits(random))), tau);
    EXPECT_GT(drag.newton_steps, 0);
    most = std::max(most, drag.newton_steps);
  }
  EXPECT_LE(most, kFew);
}

// Thresholds as small and as large beside the way as numbers go.
TEST(JointDrag, IsFiniteAndWithinReachWhateverTheThresholds) {
  const double sizes[] = {0.0, 5e-324, 1e-160, 1e-150, 1e-77, 1e-20, 1.0, 1e20, 1e154, 1e300, HUGE_VAL};
  const Vec3 dx{1.0, -0.5, 0.25};
  for (const double x : sizes) {
    for (const double y : sizes) {
      for (const double z : sizes) {
        const Vec3 tau{x, y, z};
        const JointDrag drag = drag_jointly(dx, tau);
        EXPECT_LE(drag.newton_steps, kMaxNewtonSteps);
        for (int a = 0; a < 3; ++a) {
          EXPECT_TRUE(std::isfinite(drag.moved[a]) && std::isfinite(glm::length(drag.jacobian[a])))
              << x << ' ' << y << ' ' << z;
          EXPECT_LE(std::abs(dx[a] - drag.moved[a]), tau[a] * (1.0 + 1e-8) + 1e-15)
              << x << ' ' << y << ' ' << z;
        }
      }
    }
  }
}

TEST(JointDrag, KeepsItsBitsUnderPowersOfTwo) {
  const Vec3 dx{1.3, -0.7, 0.11}, tau{0.3, 0.02, 0.7};
  const Vec3 moved = drag_jointly(dx, tau).moved;
  for (const int k : {-60, 60, 200}) {
    EXPECT_EQ(drag_jointly(dx * std::ldexp(1.0, k), tau * std::ldexp(1.0, k)).moved,
              moved * std::ldexp(1.0, k));
  }
}

}  // namespace
}  // namespace palpate
