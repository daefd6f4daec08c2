// The tuner on simulated arms whose bounds theory knows (haptics/coupling.h), unheld and in simulated time.

#include "common/servo/stiffness_tuner.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/device/replay_device.h"
#include "common/device/simulated_device.h"
#include "common/servo/tuning_run.h"
#include "common/servo/wall_loop.h"
#include "lab/hand/wall/wall_run.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/stability_limit.h"

namespace palpate::test {
namespace {

/// An arm that nobody holds, in the middle of its reach, and no limit but its motors'.
struct UnheldArm {
  explicit UnheldArm(const DeviceProfile& profile)
      : device({.profile = profile,
                .hand = kUnheld,
                .wander = WanderingPath{},
                .limits = {.force_cap = profile.peak_force, .slew_cap = 1e12}},
               nobody) {}

  ReplayDevice nobody{{}};
  SimulatedDevice device;
};

DeviceProfile plain(double mass, double damping) {
  DeviceProfile profile = find_profile("ideal");
  profile.mass = mass;
  profile.damping = damping;
  return profile;
}

TuningPlan middle(double rate, double most = 3e4) {
  return {.places = {Vec3{0.0}}, .rate = rate, .least = 50.0, .most = most, .knock = 1.0};
}

TuningResult tuned(const DeviceProfile& profile, const TuningPlan& plan) {
  UnheldArm arm(profile);
  return run_tuning(arm.device, plan, nullptr).results[0];
}

// The sampled loop swings from 2 b / T (1 + b T / 6 m) on; beyond 95 % of the bound the hold gives more than
// 19 times the knock back, which is growth.
TEST(StiffnessTuner, FindsTheBoundOfAnUnheldArm) {
  for (const auto& [mass, damping, rate] :
       {std::tuple{0.1, 2.0, 1000.0}, {0.1, 0.5, 1000.0}, {0.1, 4.0, 2000.0}, {0.3, 3.0, 500.0}}) {
    const TuningResult found = tuned(plain(mass, damping), middle(rate));
    const double bound = 2.0 * damping * rate;
    EXPECT_GT(found.stable, 0.9 * bound) << mass << " " << damping << " " << rate;
    EXPECT_LT(found.stable, linear_stability_limit(mass, damping, rate));
    EXPECT_GT(found.unstable, found.stable);
    EXPECT_LT(found.unstable, 1.02 * found.stable);
  }
}

// What the hold leaks of all that an arm loses is K / K_b, whatever its mass.
TEST(StiffnessTuner, TellsHowNearTheBoundIsByTheEnergyAlone) {
  for (const double part : {0.25, 0.5, 0.75}) {
    for (const double mass : {0.05, 0.2}) {
      TuningPlan plan = middle(1000.0, part * 4000.0);
      plan.least = plan.most;
      const TuningResult found = tuned(plain(mass, 2.0), plan);
      EXPECT_EQ(found.end, TuningEnd::kMost);
      EXPECT_NEAR(found.leak, part, 0.05) << mass;
    }
  }
}

TEST(StiffnessTuner, FindsWhatADelayLeaves) {
  for (const double delay : {0.001, 0.004}) {
    DeviceProfile profile = plain(0.1, 2.0);
    profile.actuator_delay = delay;
    const double bound = stiffness_bound(wall_loop(profile, 1000.0), 0.0).stiffness;
    const double found = tuned(profile, middle(1000.0)).stable;
    EXPECT_GT(found, 0.85 * bound) << delay;
    EXPECT_LT(found, 1.02 * bound) << delay;
  }
}

// With encoders and friction min(2 b / T, 2 f_c / step) is passive, so it is stable, too: no less is found.
TEST(StiffnessTuner, FindsNoLessThanWhatIsPassiveOnAnEncoder) {
  for (const double friction : {0.05, 0.2}) {
    DeviceProfile profile = plain(0.1, 2.0);
    profile.friction = friction;
    profile.encoder_step = 1e-4;
    const StiffnessBound bound = stiffness_bound(wall_loop(profile, 1000.0), 0.0);
    EXPECT_EQ(bound.limit, friction < 0.1 ? StiffnessLimit::kEncoder : StiffnessLimit::kHold);
    EXPECT_GT(tuned(profile, middle(1000.0)).stable, 0.9 * bound.stiffness) << friction;
  }
}

// Nothing is concluded from an arm that does not move: no stiffness would ever swing.
TEST(StiffnessTuner, ConcludesNothingFromAnArmThatDoesNotMove) {
  DeviceProfile profile = plain(0.1, 2.0);
  profile.friction = 5.0;
  UnheldArm arm(profile);
  const TuningNews news = run_tuning(arm.device, middle(1000.0), nullptr);
  EXPECT_EQ(news.results[0].end, TuningEnd::kStuck);
  EXPECT_FALSE(tuned_stiffness(news, 0.7));
}

TEST(StiffnessTuner, VisitsItsPlacesUnderTheSafeLimitsAndTakesTheLeast) {
  const DeviceProfile& falcon = find_profile("falcon");
  ReplayDevice nobody({});
  SimulatedDevice device(
      {.profile = falcon, .hand = kUnheld, .wander = WanderingPath{}, .limits = safe_limits(falcon)}, nobody);
  const TuningPlan plan{.places = tuning_places(safe_limits(falcon), 7)};
  const TuningNews news = run_tuning(device, plan, nullptr);
  ASSERT_EQ(news.count, 7U);
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < news.count; ++i) {
    EXPECT_TRUE(says_something(news.results[i].end)) << i << " " << name_of(news.results[i].end);
    EXPECT_LE(glm::length(news.results[i].place), 0.5 * 0.5 * falcon.reach.x + 1e-12);
    least = std::min(least, news.results[i].stable);
  }
  EXPECT_GT(least, 1000.0);
  EXPECT_DOUBLE_EQ(tuned_stiffness(news, 0.7).value(), 0.7 * least);
  // A replay of the same steps takes the same path.
  SimulatedDevice again(
      {.profile = falcon, .hand = kUnheld, .wander = WanderingPath{}, .limits = safe_limits(falcon)}, nobody);
  EXPECT_EQ(run_tuning(again, plan, nullptr).results[6].stable, news.results[6].stable);
}

TEST(StiffnessTuner, HasPlacesWithinReachWhereNothingBoundsIt) {
  for (const Vec3& place : tuning_places(safe_limits(find_profile("ideal")), 27))
    EXPECT_LT(glm::length(place), 0.1);
  EXPECT_EQ(tuning_places({}, 7).size(), 7U);
  EXPECT_FALSE((TuningPlan{.places = {Vec3{1e299}}}.valid()));
}

TEST(StiffnessTuner, StopsWhereTheForceIsCut) {
  DeviceProfile profile = plain(0.1, 2.0);
  ReplayDevice nobody({});
  SimulatedDevice device({.profile = profile,
                          .hand = kUnheld,
                          .wander = WanderingPath{},
                          .limits = {.enabling_button = 3}},  // which nobody holds
                         nobody);
  EXPECT_THROW((void)run_tuning(device, middle(1000.0), nullptr), Error);
}

TEST(StiffnessTuner, AllocatesNothing) {
  const auto channel = std::make_shared<StiffnessTuner::Channel>();
  StiffnessTuner tuner(middle(1000.0), channel);
  LinkUpdate link;
  tuner.update(Vec3{0.0}, {}, link);
  const AllocationGuard guard;
  for (int i = 0; i < 5000; ++i) {
    link = {};
    tuner.update({1e-4 * std::sin(0.01 * i), 0.0, 0.0}, {}, link);
    ASSERT_TRUE(is_finite(link.proxy));
  }
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace palpate::test
