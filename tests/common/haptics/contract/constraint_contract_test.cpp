// The promises of common/haptics/constraint.h, for every constraint that is registered beside this file.

#include "tests/common/haptics/contract/constraint_contract.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/support/allocation_guard.h"
#include "tests/support/lock_count.h"
#include "tests/support/samples.h"

namespace palpate::test {

namespace {

static_assert(noexcept(std::declval<Constraint&>().update(Vec3{}, UpdateBudget{},
                                                          std::declval<LinkUpdate&>())));

LinkUpdate updated(Constraint& constraint, const Vec3& probe, const UpdateBudget& budget = {}) {
  LinkUpdate link;
  constraint.update(probe, budget, link);
  return link;
}

/// K (p - x) / k [m].
Vec3 pull(const LinkUpdate& link, const Vec3& probe) {
  return link.frame * (link.kappa * ((link.proxy - probe) * link.frame));
}

bool holds(const LinkUpdate& link) {
  return link.state == HoldState::kHeld || link.state == HoldState::kFellBack;
}

/// Made, and held at the beginning of its path.
std::shared_ptr<Constraint> settled(const ContractSubject& subject, const Placement& placement = {}) {
  auto constraint = subject.make(placement);
  for (int n = 0; n < subject.settling; ++n) (void)updated(*constraint, placement.point(subject.path(0.0)));
  return constraint;
}

Mat3 any_rotation(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const Vec3 a = glm::normalize(Vec3{normal(random), normal(random), normal(random)});
  const Vec3 b{normal(random), normal(random), normal(random)};
  const Vec3 c = glm::normalize(glm::cross(a, b));
  return {a, c, glm::cross(a, c)};
}

TEST_P(ConstraintContract, ItsPathHoldsIt) {
  const auto constraint = settled(GetParam());
  constexpr int kSteps = samples_of(2000);
  int held = 0;
  for (int n = 0; n <= kSteps; ++n) held += holds(updated(*constraint, GetParam().path(1.0 * n / kSteps)));
  EXPECT_GT(held, kSteps / 2) << "the other promises would be about nothing";
}

TEST_P(ConstraintContract, StaysOnItsFeatureWithinTheReportedResidual) {
  const auto constraint = settled(GetParam());
  constexpr int kSteps = samples_of(3000);
  for (int n = 0; n <= kSteps; ++n) {
    const Vec3 probe = GetParam().path(1.0 * n / kSteps);
    const LinkUpdate link = updated(*constraint, probe);
    if (!holds(link)) continue;
    ASSERT_LE(GetParam().off_feature(probe, link), link.residual + GetParam().feature_error) << "step " << n;
  }
}

TEST_P(ConstraintContract, ASecondUpdateDoesNotMoveTheProxy) {
  const auto constraint = settled(GetParam());
  constexpr int kSteps = 1000;
  for (int n = 0; n <= kSteps; ++n) {
    const Vec3 probe = GetParam().path(1.0 * n / kSteps);
    const LinkUpdate first = updated(*constraint, probe), second = updated(*constraint, probe);
    ASSERT_EQ(first.proxy, second.proxy) << "step " << n;
    ASSERT_EQ(pull(first, probe), pull(second, probe));
    ASSERT_FALSE(second.jumped);
  }
}

// At steps from 1e-2 to 1e-5 of the path: a leap that the coarse ones hide below their bound stands out in
// the fine ones.
TEST_P(ConstraintContract, TheForceIsContinuousWhereTheRuleIs) {
  for (const int steps : {100, 3000, samples_of(100'000)}) {
    const auto constraint = settled(GetParam());
    Vec3 last = GetParam().path(0.0), last_pull = pull(updated(*constraint, last), last);
    for (int n = 1; n <= steps; ++n) {
      const Vec3 probe = GetParam().path(1.0 * n / steps);
      const LinkUpdate link = updated(*constraint, probe);
      const Vec3 now = pull(link, probe);
      const double bound = GetParam().slope * glm::distance(probe, last) + GetParam().leap;
      ASSERT_LE(glm::distance(now, last_pull), bound + 1e-9) << "step " << n << " of " << steps;
      last = probe;
      last_pull = now;
    }
  }
}

TEST_P(ConstraintContract, MovesAlongWithItsScene) {
  if (!GetParam().movable) GTEST_SKIP() << "a grid cannot be turned without being sampled anew";
  std::mt19937_64 random(1);
  for (int turn = 0; turn < 3; ++turn) {
    Placement moved{.rotation = any_rotation(random), .shift = {0.3, -0.2, 0.1}};
    const auto here = settled(GetParam()), there = settled(GetParam(), moved);
    constexpr int kSteps = 1000;
    for (int n = 0; n <= kSteps; ++n) {
      const Vec3 probe = GetParam().path(1.0 * n / kSteps);
      const LinkUpdate one = updated(*here, probe), other = updated(*there, moved.point(probe));
      ASSERT_LE(glm::distance(moved.point(one.proxy), other.proxy), GetParam().moved_error) << "step " << n;
      ASSERT_LE(glm::distance(moved.direction(pull(one, probe)), pull(other, moved.point(probe))),
                2.0 * GetParam().moved_error);
      ASSERT_EQ(one.state, other.state);
    }
  }
}

TEST_P(ConstraintContract, KeepsItsBitsUnderPowersOfTwo) {
  for (const int exponent : {-40, 40}) {
    const auto plain = settled(GetParam()), scaled = settled(GetParam(), {.exponent = exponent});
    constexpr int kSteps = 1000;
    for (int n = 0; n <= kSteps; ++n) {
      const Vec3 probe = GetParam().path(1.0 * n / kSteps);
      const LinkUpdate one = updated(*plain, probe), other = updated(*scaled, probe);
      ASSERT_EQ(one.proxy, other.proxy) << "step " << n << ", 2^" << exponent;
      ASSERT_EQ(pull(one, probe), pull(other, probe));
      ASSERT_EQ(one.extra_force, other.extra_force);
      ASSERT_EQ(one.jacobian, other.jacobian);
      ASSERT_EQ(one.residual, other.residual);
      ASSERT_EQ(one.state, other.state);
    }
  }
}

TEST_P(ConstraintContract, DoesNotFeelHowAnUndefinedFrameIsTurned) {
  for (const double turn : {0.25 * std::numbers::pi, 1.0, 2.5}) {
    const auto plain = settled(GetParam()), turned = settled(GetParam(), {.turn = turn});
    constexpr int kSteps = 1000;
    for (int n = 0; n <= kSteps; ++n) {
      const Vec3 probe = GetParam().path(1.0 * n / kSteps);
      const LinkUpdate one = updated(*plain, probe), other = updated(*turned, probe);
      ASSERT_LE(glm::distance(one.proxy, other.proxy), GetParam().moved_error) << "step " << n;
      ASSERT_LE(glm::distance(pull(one, probe), pull(other, probe)), 2.0 * GetParam().moved_error);
    }
  }
}

TEST_P(ConstraintContract, SaysHowItsProxyMoves) {
  constexpr double kAside = 1e-6;  // [m]
  constexpr int kSteps = 200;
  for (const double s : GetParam().smooth_at) {
    const auto last_at = [&](const Vec3& aside) {
      const auto constraint = settled(GetParam());
      for (int n = 0; n < kSteps; ++n) (void)updated(*constraint, GetParam().path(s * n / kSteps));
      return updated(*constraint, GetParam().path(s) + aside);
    };
    const LinkUpdate here = last_at(Vec3{0.0});
    for (int a = 0; a < 3; ++a) {
      Vec3 aside{0.0};
      aside[a] = kAside;
      const Vec3 slope = (last_at(aside).proxy - last_at(-aside).proxy) / (2.0 * kAside);
      EXPECT_LE(glm::distance(here.jacobian[a], slope), GetParam().jacobian_error)
          << "axis " << a << " at " << s;
    }
  }
}

// Forgotten, it is as good as new, whatever it went through.
TEST_P(ConstraintContract, ForgetsWhenReset) {
  const auto used = settled(GetParam()), fresh = settled(GetParam());
  constexpr int kSteps = 300;
  for (int n = 0; n <= kSteps; ++n) (void)updated(*used, GetParam().path(1.0 * n / kSteps));
  used->reset();
  fresh->reset();
  for (int n = 0; n <= kSteps; ++n) {
    const Vec3 probe = GetParam().path(1.0 * n / kSteps);
    const LinkUpdate one = updated(*used, probe), other = updated(*fresh, probe);
    ASSERT_EQ(one.proxy, other.proxy) << "step " << n;
    ASSERT_EQ(one.state, other.state);
  }
}

// Probes that creep, leap, and come from far outside, with budgets down to almost nothing.
TEST_P(ConstraintContract, BoundsItsWorkAndAllocatesLocksAndThrowsNothing) {
  const ContractSubject& subject = GetParam();
  for (const UpdateBudget budget : {UpdateBudget{}, UpdateBudget{.iterations = 3, .cells = 2},
                                    UpdateBudget{.iterations = 1, .cells = 1}}) {
    const auto constraint = subject.make({});
    std::mt19937_64 random(2);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> unit;
    Vec3 probe = subject.path(0.0);
    const AllocationGuard allocations;
    const LockCount locks;
    for (int n = 0; n < samples_of(20'000); ++n) {
      const double kind = unit(random);
      const Vec3 any{normal(random), normal(random), normal(random)};
      if (kind < 0.9) {
        probe += 1e-3 * any;
      } else if (kind < 0.98) {
        probe = subject.path(unit(random)) + 1e-2 * any;
      } else if (kind < 0.99) {
        probe = subject.wild * any;
      } else {
        probe = std::pow(10.0, 12.0 * unit(random) - 6.0) * any;
      }
      const LinkUpdate link = updated(*constraint, probe, budget);
      ASSERT_LE(link.iterations, budget.iterations) << "step " << n;
      ASSERT_TRUE(is_finite(link.proxy)) << "step " << n;
      ASSERT_TRUE(is_finite(pull(link, probe)) && is_finite(link.extra_force)) << "step " << n;
      ASSERT_TRUE(is_finite(link.jacobian[0]) && is_finite(link.jacobian[1]) && is_finite(link.jacobian[2]));
      ASSERT_TRUE(std::isfinite(link.residual) && link.residual >= 0.0);
      const Vec3 least = glm::min(link.kappa, Vec3{1.0} - link.kappa);
      ASSERT_GE(std::min({least.x, least.y, least.z}), 0.0) << "kappa in [0, 1]";
      const Mat3 identity = glm::transpose(link.frame) * link.frame;
      for (int a = 0; a < 3; ++a) {
        Vec3 expected{0.0};
        expected[a] = 1.0;
        ASSERT_LE(glm::distance(identity[a], expected), 1e-12) << "axes are orthonormal, step " << n;
      }
    }
    EXPECT_EQ(allocations.count(), 0U);
    EXPECT_EQ(locks.count(), 0U);
  }
}

}  // namespace
}  // namespace palpate::test
