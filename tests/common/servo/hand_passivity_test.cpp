// What the servo step makes of velocity estimate, coupling damper and passivity controller.

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "common/servo/hand_step.h"
#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

constexpr double kTick = 0.001;  // [s]
const DeviceLimits kFree{.force_cap = 1e3, .slew_cap = 1e9};

/// Keeps its proxy at x >= 0.
class Wall final : public Constraint {
 public:
  void apply(const ChainSettings&) noexcept override {}
  void reset() noexcept override {}
  void update(const Vec3& probe, const UpdateBudget&, LinkUpdate& link) noexcept override {
    link.proxy = {std::max(probe.x, 0.0), probe.y, probe.z};
    if (probe.x >= 0.0) return;
    link.state = HoldState::kHeld;
    link.jacobian[0][0] = 0.0;
  }
};

/// Drives the hand along x by a force, and holds nothing.
class Drive final : public Constraint {
 public:
  void apply(const ChainSettings&) noexcept override {}
  void reset() noexcept override {}
  void update(const Vec3& probe, const UpdateBudget&, LinkUpdate& link) noexcept override {
    link.proxy = probe;
    link.extra_force = {0.7, 0.0, 0.0};
  }
};

template <typename... Links>
std::unique_ptr<ProxyChain> chain_of(const ChainSettings& settings) {
  std::vector<std::unique_ptr<Constraint>> links;
  (links.push_back(std::make_unique<Links>()), ...);
  return std::make_unique<ProxyChain>(std::move(links), settings);
}

/// The hand goes into the wall and out again at constant speed, again and again.
struct Cycles {
  double to_hand = 0.0;  ///< [J]
  double largest_damping = 0.0;
};

Cycles in_and_out(std::unique_ptr<ProxyChain> chain) {
  constexpr double kSpeed = 0.05, kDepth = 0.002;
  HandStepper stepper(std::move(chain), kFree);
  Cycles result;
  double x = 1e-4;
  Vec3 force{0.0};
  for (int n = 0; n < 4000; ++n) {
    const double phase = std::fmod(n * kTick * kSpeed, 2.0 * kDepth);
    const double next = 1e-4 - (phase < kDepth ? phase : 2.0 * kDepth - phase);
    result.to_hand += force.x * (next - x);
    x = next;
    const HandStep step =
        stepper.step({.time = kTick * n, .present = true, .sample = {kTick * n, {x, 0.0, 0.0}, 0}});
    force = step.force;
    result.largest_damping = std::max(result.largest_damping, step.passivity_damping);
  }
  return result;
}

TEST(HandPassivity, IsWatchedOverInChainsOfTwoLinksByDefault) {
  ChainSettings settings{.stiffness = 4000.0};
  const Cycles one = in_and_out(chain_of<Wall>(settings));
  EXPECT_GT(one.to_hand, 0.01) << "4000 N/m at 50 mm/s leak 0.4 mJ a cycle";
  EXPECT_EQ(one.largest_damping, 0.0);
  const Cycles two = in_and_out(chain_of<Wall, Wall>(settings));
  // An arm takes 0.1 N s/m by itself, which is left to it: at 50 mm/s over 0.2 m.
  constexpr double kArm = 0.1 * 0.05 * 0.2;
  EXPECT_LE(two.to_hand, kArm);
  EXPECT_GT(two.largest_damping, 0.0);
  settings.passivity.from_links = 1.0;
  EXPECT_LE(in_and_out(chain_of<Wall>(settings)).to_hand, kArm);
  settings.passivity.from_links = 100.0;
  EXPECT_EQ(in_and_out(chain_of<Wall, Wall>(settings)).to_hand, one.to_hand);
}

// A force that is meant to drive the hand is no leak of a spring.
TEST(HandPassivity, LetsADrivingForceDrive) {
  HandStepper stepper(chain_of<Wall, Drive>({}), kFree);
  Vec3 force{0.0};
  for (int n = 0; n < 500; ++n) {
    const double t = kTick * n;
    const HandStep step = stepper.step({.time = t, .present = true, .sample = {t, {0.05 * t, 0.0, 0.0}, 0}});
    EXPECT_EQ(step.passivity_damping, 0.0);
    force = step.force;
  }
  EXPECT_EQ(force, Vec3(0.7, 0.0, 0.0));
}

// Along the wall the hand is free, and into it the damper adds b v to the spring; outside there is neither.
TEST(HandPassivity, DampsTheMotionThatIsHeldBack) {
  const Vec3 velocity{-0.04, 0.03, 0.0};
  HandStepper stepper(chain_of<Wall>({.stiffness = 300.0, .damping = 2.5}), kFree);
  for (int n = 0; n < 100; ++n) {
    const double t = kTick * n;
    const Vec3 x = Vec3{0.002, 0.0, 0.0} + velocity * t;
    const HandStep step = stepper.step({.time = t, .present = true, .sample = {t, x, 0}});
    if (x.x > 0.0) {
      EXPECT_EQ(step.force, Vec3(0.0));
    } else if (x.x < -1e-12) {
      EXPECT_NEAR(step.force.x, -300.0 * x.x + 2.5 * 0.04, 1e-9);
      EXPECT_EQ(step.force.y, 0.0);
    }
  }
}

TEST(HandPassivity, AllocatesNothing) {
  HandStepper stepper(chain_of<Wall, Wall>({.stiffness = 4000.0, .damping = 1.0}), kFree);
  const AllocationGuard guard;
  for (int n = 0; n < 1000; ++n) {
    const double t = kTick * n;
    (void)stepper.step({.time = t, .present = true, .sample = {t, {1e-3 * std::sin(40.0 * t), 0.0, 0.0}, 0}});
  }
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace palpate::test
