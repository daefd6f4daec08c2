// The streamline constraint on linear flows over random tetrahedra, whose streamlines are known exactly.

#include "common/haptics/constraint/streamline.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "tests/common/haptics/followed_flow.h"
#include "tests/support/allocation_guard.h"

namespace palpate {
namespace {

using test::FollowedFlow;
using test::rows;

constexpr double kDiagonal = 2.0 * std::numbers::sqrt3;
constexpr double kResidual = 1e-6 * kDiagonal;  // what the contract allows

std::shared_ptr<const VectorField> rotation() {
  return test::on_tetrahedra(rows(0, -2, 0, 2, 0, 0, 0, 0, 0), Vec3{0.0}, 9, 0.2, 1);
}
std::shared_ptr<const VectorField> helix() {
  return test::on_tetrahedra(rows(0, -16, 0, 16, 0, 0, 0, 0, 0.125), Vec3{0.0, 0.0, -4.0}, 9, 0.2, 1);
}
std::shared_ptr<const VectorField> sink() {
  return test::on_tetrahedra(rows(-1, -8, 0, 8, -1, 0, 0, 0, -2), Vec3{0.0625, 0.03125, 0.0}, 9, 0.2, 1);
}

Vec3 polar(double radius, double angle, double z = 0.0) {
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

TEST(Streamline, HoldsTheProxyAtTheNearestPointOfTheLine) {
  FollowedFlow flow(rotation());
  EXPECT_EQ(flow.chain->step(polar(0.5, 0.0)).force, Vec3{0.0}) << "caught where the probe is";
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> wobble(-0.04, 0.04);
  double angle = 0.0;
  for (int n = 0; n < 20'000; ++n) {
    angle += 0.004 * std::sin(n * 1e-3) + 0.001;  // several turns forward, and some back
    const double radius = 0.5 + wobble(random);
    const Vec3 probe = polar(radius, angle, wobble(random));
    const ChainStep step = flow.chain->step(probe);
    ASSERT_EQ(step.state, HoldState::kHeld) << "step " << n;
    ASSERT_LE(glm::distance(step.proxies[0], polar(0.5, angle)), kResidual) << "step " << n;
    ASSERT_LE(step.residual, kResidual);
    ASSERT_LE(glm::distance(step.force, 200.0 * (step.proxies[0] - probe)), 1e-12);
  }
  EXPECT_EQ(flow.constraint->catches(), 1u) << "a closed line goes on for ever, and is the same line";
}

TEST(Streamline, ASecondUpdateDoesNotMoveTheProxy) {
  FollowedFlow flow(helix());
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> any(-0.02, 0.02);
  (void)flow.chain->step({0.5, 0.0, 0.0});
  for (int n = 0; n < 200; ++n) (void)flow.chain->step({0.5, 0.0, 0.0});  // grown
  for (int n = 0; n < 1000; ++n) {
    const Vec3 probe{0.5 + any(random), any(random), any(random)};
    const Vec3 first = flow.chain->step(probe).proxies[0];
    EXPECT_EQ(flow.chain->step(probe).proxies[0], first);
  }
}

TEST(Streamline, LetsGoAndIsCaughtByTheNextLine) {
  FollowedFlow flow(rotation(), 0.1);
  (void)flow.chain->step(polar(0.5, 0.0));
  EXPECT_EQ(flow.chain->step(polar(0.599, 0.0)).state, HoldState::kHeld);
  const ChainStep over = flow.chain->step(polar(0.602, 0.0));
  EXPECT_EQ(over.state, HoldState::kReleased);
  EXPECT_TRUE(over.jumped);
  EXPECT_EQ(over.force, Vec3{0.0}) << "the new line passes through the probe";
  const ChainStep held = flow.chain->step(polar(0.55, 0.3));
  EXPECT_EQ(held.state, HoldState::kHeld);
  EXPECT_LE(glm::distance(held.proxies[0], polar(0.602, 0.3)), kResidual);
}

// The coils of the helix are 0.2 apart: the nearest point of the whole line would leap to the next coil
// halfway.
TEST(Streamline, StaysOnItsOwnCoil) {
  FollowedFlow flow(helix(), 0.5);
  (void)flow.chain->step({0.5, 0.0, 0.0});
  for (int n = 0; n < 500; ++n) (void)flow.chain->step({0.5, 0.0, 0.0});
  double farthest = 0.0;
  for (int n = 0; n <= 150; ++n) {
    const ChainStep step = flow.chain->step({0.5, 0.0, n * 1e-3});
    ASSERT_EQ(step.state, HoldState::kHeld);
    farthest = std::max(farthest, glm::distance(step.proxies[0], Vec3{0.5, 0.0, 0.0}));
  }
  EXPECT_LT(farthest, 0.05);
}

TEST(Streamline, StaysAtTheBorderUntilItLetsGo) {
  // Straight lines along x, faster with z.
  FollowedFlow flow(test::on_tetrahedra(rows(0, 0, 1, 0, 0, 0, 0, 0, 0), Vec3{0.0, 0.0, -2.0}, 9, 0.2, 1));
  (void)flow.chain->step({0.9, 0.2, 0.3});
  for (int n = 0; n < 50; ++n) (void)flow.chain->step({0.9, 0.2, 0.3});
  const ChainStep beyond = flow.chain->step({1.08, 0.2, 0.3});
  EXPECT_EQ(beyond.state, HoldState::kHeld);
  EXPECT_LE(glm::distance(beyond.proxies[0], Vec3{1.0, 0.2, 0.3}), kResidual);
  EXPECT_EQ(flow.chain->step({1.2, 0.2, 0.3}).state, HoldState::kReleased);
  const ChainStep away = flow.chain->step({1.3, 0.2, 0.3});
  EXPECT_EQ(away.state, HoldState::kOutside);
  EXPECT_EQ(away.force, Vec3{0.0});
  const ChainStep back = flow.chain->step({0.99, -0.4, 0.3});
  EXPECT_EQ(back.state, HoldState::kHeld);
  EXPECT_EQ(back.force, Vec3{0.0});
}

TEST(Streamline, RestsAtACriticalPoint) {
  FollowedFlow flow(sink());
  const Vec3 rest{0.0625, 0.03125, 0.0};
  Vec3 probe{0.5, 0.4, 0.3};
  (void)flow.chain->step(probe);
  // The probe is carried by the flow (to rounding), and then waits at the critical point.
  for (int n = 0; n < 6000; ++n) {
    CellHint hint;
    probe += 1e-3 * flow.field->sample(probe, hint).value;
    const ChainStep step = flow.chain->step(probe);
    ASSERT_TRUE(is_finite(step.force));
    ASSERT_LE(step.residual, kResidual);
  }
  // Wherever it is pulled from there, the line holds it no farther than the release distance.
  ChainStep pulled;
  for (int n = 0; n < 100; ++n) pulled = flow.chain->step(rest + Vec3{0.0, 0.0, -0.05});
  EXPECT_EQ(pulled.state, HoldState::kFellBack);
  EXPECT_LE(glm::distance(pulled.proxies[0], rest), 1e-4);
}

TEST(Streamline, HoldsNothingWhereTheFlowRests) {
  FollowedFlow flow(test::on_tetrahedra(rows(0, 0, 0, 0, 0, 0, 0, 0, 0), Vec3{0.0}, 5, 0.2, 1));
  const ChainStep step = flow.chain->step({0.1, 0.2, 0.3});
  EXPECT_EQ(step.state, HoldState::kFellBack);
  EXPECT_EQ(step.force, Vec3{0.0});
}

TEST(Streamline, KeepsItsBitsUnderPowersOfTwo) {
  const Mat3 a = rows(-1, -8, 0, 8, -1, 0, 0, 0, -2);
  const Vec3 c{0.0625, 0.03125, 0.0};
  for (const int k : {-40, 40}) {
    FollowedFlow small(test::on_tetrahedra(a, c, 7, 0.2, 1), 0.03);
    FollowedFlow large(test::on_tetrahedra(a, c, 7, 0.2, 1, 1.0, k, -k), 0.03, 0.0, std::ldexp(1.0, -k));
    std::mt19937_64 random(5);
    std::normal_distribution<double> tremor(0.0, 0.01);
    Vec3 probe{0.5, 0.4, 0.3};
    for (int n = 0; n < 2000; ++n) {
      probe += Vec3{tremor(random), tremor(random), tremor(random)};
      probe = glm::clamp(probe, Vec3{-1.1}, Vec3{1.1});
      const ChainStep one = small.chain->step(probe), other = large.chain->step(probe);
      ASSERT_EQ(one.proxies[0], other.proxies[0]) << "step " << n << ", 2^" << k;
      ASSERT_EQ(one.force, other.force);
      ASSERT_EQ(one.state, other.state);
      ASSERT_EQ(one.residual, other.residual);
    }
  }
}

// Any path, budgets down to almost nothing: no allocation, work within the budget (and one piece of the line
// above it), a proxy on the line.
TEST(Streamline, BoundsItsWorkAndAllocatesNothing) {
  for (const auto& field : {rotation(), helix(), sink(),
                            test::on_tetrahedra(rows(-268435456, 0, 0, 268435455, -1, 0, 0, 0, 1),
                                                {0.0625, 0.03125, 0.25}, 7, 0.2, 1)}) {
    for (const UpdateBudget budget : {UpdateBudget{}, UpdateBudget{.iterations = 3, .cells = 2}}) {
      FollowedFlow flow(field);
      flow.chain->set_budget(budget);
      std::mt19937_64 random(6);
      std::normal_distribution<double> tremor;
      Vec3 probe{0.3, 0.2, 0.1};
      const test::AllocationGuard allocations;
      for (int n = 0; n < 5000; ++n) {
        const double step_size = n % 100 == 0 ? 0.5 : 0.01;
        probe += step_size * Vec3{tremor(random), tremor(random), tremor(random)};
        probe = glm::clamp(probe, Vec3{-1.2}, Vec3{1.2});
        const ChainStep step = flow.chain->step(probe);
        ASSERT_TRUE(is_finite(step.force));
        ASSERT_LE(step.iterations, budget.iterations);
        constexpr int kDearestPiece = 128;
        ASSERT_LE(step.cells, 2 * budget.cells + 2 * kDearestPiece);
        ASSERT_LE(glm::distance(step.proxy(probe), probe), 0.1 + 1e-12);
        ASSERT_LE(step.residual, kResidual);
      }
      EXPECT_EQ(allocations.count(), 0u);
    }
  }
}

TEST(Streamline, PushesAlongTheLineBySpeed) {
  FollowedFlow flow(rotation());
  ChainSettings settings = flow.chain->settings();
  settings.streamline.speed_force = 1.0;
  flow.chain->apply(settings);
  for (const double radius : {0.25, 0.5}) {
    flow.chain->reset();
    (void)flow.chain->step(polar(radius, 0.0));
    const Vec3 force = flow.chain->step(polar(radius, 0.0)).force;
    // |v| = 2 r; the fastest corner of the cube moves at 2 sqrt(2).
    EXPECT_NEAR(force.y, radius / std::numbers::sqrt2, 1e-6);
    EXPECT_NEAR(force.x, 0.0, 1e-6);
  }
}

}  // namespace
}  // namespace palpate
