// Vibrations that tell of events: when they begin, what they are, and that the safety stage has the last word.

#include "common/servo/event_pulse.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/haptics/constraint/half_space.h"
#include "common/haptics/constraint/shape.h"
#include "common/servo/hand_step.h"

namespace palpate {
namespace {

constexpr double kTick = 0.001;  // [s]
constexpr EventSettings kEvents{.force = 0.5, .frequency = 125.0};

HandStepper stepper_of(std::unique_ptr<Constraint> link, const EventSettings& events,
                       const DeviceLimits& limits = {.force_cap = 1e3, .slew_cap = 1e9}) {
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::move(link));
  ChainSettings settings;
  settings.stiffness = 0.0;  // nothing else is felt
  settings.shape = {.snap_distance = 1.0, .release_distance = 1.0};
  settings.events = events;
  return {std::make_unique<ProxyChain>(std::move(links), settings), limits};
}

HandStep at(HandStepper& stepper, int tick, const Vec3& probe) {
  HandInput input{.time = kTick * tick, .present = true};
  input.sample = {input.time, probe, 0};
  return stepper.step(input);
}

TEST(EventPulse, OfASurfaceIsADecayingSine) {
  HandStepper stepper =
      stepper_of(std::make_unique<HalfSpaceConstraint>(Vec3{0.0}, Vec3{0.0, 0.0, 1.0}), kEvents);
  for (int n = 0; n < 20; ++n) ASSERT_EQ(at(stepper, n, {0.0, 0.0, 0.01}).force, Vec3{0.0});
  constexpr int kMet = 20;
  for (int n = kMet; n < kMet + 400; ++n) {
    const double t = kTick * (n - kMet);
    const double expected =
        t < 0.15 ? 0.5 * std::exp(-t / 0.03) * std::sin(2.0 * std::numbers::pi * 125.0 * t) : 0.0;
    ASSERT_NEAR(at(stepper, n, {0.0, 0.0, -0.001}).force.y, expected, 1e-9) << n;
  }
  (void)at(stepper, 500, {0.0, 0.0, 0.001});
  EXPECT_NE(at(stepper, 501, {0.0, 0.0, 0.001}).force.y, 0.0) << "it is left";
}

TEST(EventPulse, TellsOfTheEndOfALineOnce) {
  HandStepper stepper =
      stepper_of(std::make_unique<PolylineConstraint>(Vec3{0.0}, Vec3{0.1, 0.0, 0.0}), kEvents);
  int begun = 0;
  bool before = false;
  for (int n = 0; n < 2000; ++n) {
    const double x = std::min(0.2, 0.05 + 0.0002 * n);
    const bool shakes = at(stepper, n, {x, 0.0, 0.0}).force != Vec3{0.0};
    begun += shakes && !before ? 1 : 0;
    before = shakes || (before && n % 4 == 0);  // a sine passes zero
  }
  EXPECT_GE(begun, 1);
  EXPECT_EQ(at(stepper, 2000, {0.2, 0.0, 0.0}).force, Vec3{0.0}) << "and not for ever";
}

TEST(EventPulse, IsNoneWhereNoneIsAskedFor) {
  HandStepper stepper = stepper_of(std::make_unique<HalfSpaceConstraint>(Vec3{0.0}, Vec3{0.0, 0.0, 1.0}), {});
  for (int n = 0; n < 200; ++n)
    ASSERT_EQ(at(stepper, n, {0.0, 0.0, n % 20 < 10 ? 0.001 : -0.001}).force, Vec3{0.0});
}

TEST(EventPulse, StaysBelowCapAndSlew) {
  const DeviceLimits limits{.force_cap = 0.2, .slew_cap = 50.0};
  HandStepper stepper = stepper_of(std::make_unique<HalfSpaceConstraint>(Vec3{0.0}, Vec3{0.0, 0.0, 1.0}),
                                   {.force = 4.0}, limits);
  Vec3 before{0.0};
  for (int n = 0; n < 3000; ++n) {
    const Vec3 force = at(stepper, n, {0.0, 0.0, n % 90 < 45 ? 0.001 : -0.001}).force;
    ASSERT_LE(glm::length(force), 0.2 + 1e-12);
    if (force != Vec3{0.0}) {
      ASSERT_LE(glm::distance(force, before), 50.0 * kTick + 1e-9) << n;
    }
    before = force;
  }
}

TEST(Viscosity, DragsAHandThatMovesAndNoOther) {
  ChainSettings settings;
  settings.viscosity = 3.0;
  ProxyChain chain({}, settings);
  EXPECT_LE(glm::distance(chain.step({0.1, 0.2, 0.3}, {0.1, 0.0, -0.2}).force, Vec3(-0.3, 0.0, 0.6)), 1e-15);
  EXPECT_EQ(chain.step({0.1, 0.2, 0.3}, Vec3{0.0}).force, Vec3{0.0});
}

}  // namespace
}  // namespace palpate
