#include "common/haptics/passivity.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

constexpr double kTick = 0.001;  // [s]
constexpr double kRoom = 1.0;    // [J] as good as unlimited storage
constexpr double kArm = 0.1;     // [N s/m] that the controller leaves to the arm
constexpr PassivitySettings kSettings{.from_links = 1.0, .max_damping = 50.0, .dead_speed = 1e-4};

/// A hand that is led along a wall x = 0, with the wall's force as it is.
struct Led {
  double stiffness;
  PassivityController controller{};
  double force = 0.0;
  double to_hand = 0.0;  ///< [J] work of the forces that were sent

  void go(double from, double to) {
    to_hand += force * (to - from);
    const double wall = to > 0.0 ? -stiffness * to : 0.0;
    const double stored = 0.5 * stiffness * to * to;
    force = controller.control({to, 0.0, 0.0}, kTick, {wall, 0.0, 0.0}, stored, kSettings).x;
    controller.sent({force, 0.0, 0.0});
  }
};

// In and out at constant speed: each tick of the way in the held force falls short of the spring's, on the
// way out it exceeds it, by K v T / 2 either way. So the wall gives K v T p a cycle, of which the arm takes 2
// b_0 v p, and the observer, in its exact bookkeeping, shows all of it.
TEST(PassivityController, ObservesExactlyWhatTheHoldLeaks) {
  constexpr double kStiffness = 2000.0, kSpeed = 0.02;
  constexpr int kTicks = 100;
  PassivityController observer;
  constexpr PassivitySettings kWatchOnly{.max_damping = 0.0};
  double force = 0.0;
  for (int n = -1; n <= 2 * kTicks; ++n) {
    const double x = kSpeed * kTick * (n <= kTicks ? n : 2 * kTicks - n);
    force = x > 0.0 ? -kStiffness * x : 0.0;
    EXPECT_EQ(observer.control({x, 0.0, 0.0}, kTick, {force, 0.0, 0.0}, kRoom, kWatchOnly).x, force);
    observer.sent({force, 0.0, 0.0});
  }
  const double depth = kSpeed * kTick * kTicks;
  // Outside the wall, in the last tick, the arm takes a little more.
  const double tick = kSpeed * kTick;
  EXPECT_NEAR(observer.energy(), -kStiffness * tick * depth + 2.0 * kArm * kSpeed * (depth + 0.5 * tick),
              kArm * kSpeed * tick);
}

TEST(PassivityController, TakesBackWhatTheWallGave) {
  for (const double stiffness : {500.0, 2000.0, 8000.0}) {
    Led hand{stiffness};
    double x = -1e-4;
    const auto to = [&](double next) {
      hand.go(x, next);
      x = next;
    };
    for (int cycle = 0; cycle < 20; ++cycle) {
      for (int n = 0; n < 100; ++n) to(x + 2e-5);
      for (int n = 0; n < 100; ++n) to(x - 2e-5);
      for (int n = 0; n < 100; ++n) to(x - 2e-5);
      for (int n = 0; n < 100; ++n) to(x + 2e-5);
      const double arm = kArm * (2e-5 / kTick) * (400 * 2e-5) * (cycle + 1);  // b_0 v a metre
      EXPECT_LE(hand.to_hand, arm) << "cycle " << cycle << " at " << stiffness;
    }
    EXPECT_GE(hand.controller.energy(), -1e-12);
  }
}

// At 2 b_0 / T, the bound of an arm with that damping: 200 N/m at 1 kHz.
TEST(PassivityController, LeavesToTheArmWhatItsOwnDampingTakes) {
  for (const double stiffness : {190.0, 250.0}) {
    Led hand{stiffness};
    double largest = 0.0, x = 0.0;
    for (int n = 0; n < 4000; ++n) {
      const double next = 1e-3 * (1.0 - std::cos(0.02 * n));
      hand.go(x, next);
      x = next;
      largest = std::max(largest, hand.controller.damping());
    }
    EXPECT_EQ(largest > 0.0, stiffness > 200.0) << stiffness;
  }
}

TEST(PassivityController, LeavesAPassiveWallAlone) {
  // A wall that pushes by less on the way out: friction, if of an odd kind.
  PassivityController controller;
  for (int n = 0; n <= 200; ++n) {
    const bool in = n <= 100;
    const double x = 2e-5 * (in ? n : 200 - n);
    const Vec3 force{-1000.0 * x * (in ? 1.0 : 0.8), 0.0, 0.0};
    EXPECT_EQ(controller.control({x, 0.0, 0.0}, kTick, force, kRoom, kSettings), force);
    EXPECT_EQ(controller.damping(), 0.0);
    controller.sent(force);
  }
  EXPECT_GT(controller.energy(), 0.0);
}

// Drag takes energy for good. Were it kept as credit, the source that follows would go unseen.
TEST(PassivityController, GivesNoCreditForWhatWasLost) {
  PassivityController controller;
  double x = 0.0;
  const auto move = [&](double dx, double force) {
    const double stored = 0.5 * 1e-4;  // [J] that the springs hold at most
    x += dx;
    const double sent = controller.control({x, 0.0, 0.0}, kTick, {force, 0.0, 0.0}, stored, kSettings).x;
    controller.sent({sent, 0.0, 0.0});
    return sent;
  };
  for (int n = 0; n < 1000; ++n) (void)move(1e-4, -1.0);  // 0.1 J
  EXPECT_LE(controller.energy(), 0.5e-4);
  double given = 0.0;
  for (int n = 0; n < 1000; ++n) given += 1e-4 * move(1e-4, 1.0);
  const double arm = kArm * 0.1 * 0.1;  // [J] at 0.1 m/s over 0.1 m
  EXPECT_LT(given, arm + 3e-4) << "of 0.1 J that it would have given";
}

TEST(PassivityController, DampsAgainstTheMotionAndNoMoreThanItMay) {
  PassivityController controller;
  (void)controller.control(Vec3{0.0}, kTick, Vec3{0.0}, kRoom, kSettings);
  controller.sent({0.0, 30.0, 0.0});
  const Vec3 step{1e-4, 2e-4, -1e-4};
  const Vec3 force = controller.control(step, kTick, Vec3{0.0}, kRoom, kSettings);
  EXPECT_EQ(controller.damping(), kSettings.max_damping) << "6 mJ would take 100 N s/m and more";
  EXPECT_NEAR(glm::distance(force, -(kSettings.max_damping / kTick) * step), 0.0, 1e-12);
  PassivityController slight;
  (void)slight.control(Vec3{0.0}, kTick, Vec3{0.0}, kRoom, kSettings);
  slight.sent({0.0, 1.0, 0.0});
  (void)slight.control(step, kTick, Vec3{0.0}, kRoom, kSettings);
  EXPECT_NEAR(slight.damping(), 1.0 * 2e-4 * kTick / glm::dot(step, step) - kArm, 1e-12);
}

TEST(PassivityController, LeavesASlowHandAlone) {
  PassivityController controller;
  (void)controller.control(Vec3{0.0}, kTick, Vec3{0.0}, kRoom, kSettings);
  controller.sent({5.0, 0.0, 0.0});
  const double dead = kSettings.dead_speed * kTick;
  EXPECT_EQ(controller.control({0.99 * dead, 0.0, 0.0}, kTick, Vec3{0.0}, kRoom, kSettings), Vec3(0.0));
  EXPECT_LT(controller.energy(), 0.0);
  EXPECT_NE(controller.control({2.1 * dead, 0.0, 0.0}, kTick, Vec3{0.0}, kRoom, kSettings), Vec3(0.0));
}

TEST(PassivityController, ForgetsADebtOnceNothingIsFelt) {
  PassivityController controller;
  const Vec3 there{1e-3, 0.0, 0.0};
  (void)controller.control(Vec3{0.0}, kTick, Vec3{0.0}, kRoom, kSettings);
  controller.sent({5.0, 0.0, 0.0});
  (void)controller.control(there, kTick, Vec3{0.0}, kRoom, kSettings);
  controller.sent(Vec3{0.0});
  int steps = 0;
  for (; controller.energy() < 0.0 && steps < 1000; ++steps) {
    (void)controller.control(there, kTick, Vec3{0.0}, kRoom, kSettings);
    controller.sent(Vec3{0.0});
  }
  EXPECT_NEAR(kTick * steps, PassivityController::kForgetAfter, 2.5 * kTick);
}

TEST(PassivityController, DoesNotHoldAgainstTheSpringsWhatIsMeantToDrive) {
  PassivityController controller;
  for (int n = 0; n < 100; ++n) {
    const Vec3 x{1e-4 * n, 0.0, 0.0}, drive{0.5, 0.0, 0.0};
    EXPECT_EQ(controller.control(x, kTick, drive, 0.0, kSettings), drive);
    controller.sent(drive, drive);
  }
  EXPECT_EQ(controller.energy(), 0.0);
}

TEST(PassivityController, AllocatesNothing) {
  Led hand{2000.0};
  const AllocationGuard guard;
  for (int n = 0; n < 1000; ++n) hand.go(1e-3 * std::sin(0.1 * n), 1e-3 * std::sin(0.1 * (n + 1)));
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace palpate::test
