#include "common/servo/hand_step.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/common/servo/sphere_drag.h"
#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kRadius = 0.05;  // [m]
const Vec3 kNear{0.0, 0.0, 0.052};

HandInput at(double t, const Vec3& x) { return {.time = t, .present = true, .sample = {t, x, 0}}; }

/// A stepper that has been held at kNear for long enough to show the whole force. @param t [s] of its last
/// step.
HandStepper held(double& t, const DeviceLimits& limits = {}) {
  HandStepper stepper(sphere_chain(kRadius), limits);
  for (t = 0.0; t < 0.1; t += 0.001) (void)stepper.step(at(t, kNear));
  t -= 0.001;
  return stepper;
}

TEST(HandStepper, PullsTheProbeToItsProxyOnceTheForceHasGrown) {
  double t = 0.0;
  HandStepper stepper = held(t);
  const HandStep step = stepper.step(at(t + 0.001, kNear));
  EXPECT_EQ(step.state, HoldState::kHeld);
  EXPECT_EQ(step.number, 100U);
  EXPECT_EQ(step.probe, kNear);
  EXPECT_NEAR(glm::distance(step.chain.proxy(kNear), Vec3(0, 0, kRadius)), 0.0, 1e-15);
  EXPECT_NEAR(step.force.z, -200.0 * 0.002, 1e-12);
}

TEST(HandStepper, GivesNoForceInTheFirstStep) {
  HandStepper stepper(sphere_chain(kRadius), {.slew_cap = 100.0});
  EXPECT_EQ(stepper.step(at(5.0, kNear)).force, Vec3(0.0));
  EXPECT_NEAR(stepper.step(at(5.001, kNear)).force.z, -0.1, 1e-12);
}

TEST(HandStepper, LeavesTheProxiesAsTheyWereOnAFault) {
  for (const auto& [dt, x, cut] :
       {std::tuple{0.001, Vec3{kNan, 0, 0}, ForceCut::kNotFinite},
        std::tuple{0.001, Vec3{0, kInf, 0}, ForceCut::kNotFinite},
        std::tuple{kNan, kNear, ForceCut::kNotFinite}, std::tuple{0.0, Vec3{0.049, 0, 0}, ForceCut::kTime},
        std::tuple{-0.05, Vec3{0.049, 0, 0}, ForceCut::kTime}}) {
    double t = 0.0;
    HandStepper stepper = held(t);
    const HandStep fault = stepper.step(at(t + dt, x));
    EXPECT_EQ(fault.state, HoldState::kFault);
    EXPECT_EQ(fault.cut, cut);
    EXPECT_EQ(fault.force, Vec3(0.0));
    EXPECT_EQ(fault.probe, kNear) << "the last one that made sense";
    ASSERT_EQ(fault.chain.links, 1);
    EXPECT_NEAR(glm::distance(fault.chain.proxies[0], Vec3(0, 0, kRadius)), 0.0, 1e-15);
    // Time goes on from where it is now: only this step was at fault.
    const HandStep next = stepper.step(at((std::isnan(dt) ? t : t + dt) + 0.001, kNear));
    EXPECT_EQ(next.state, HoldState::kHeld) << name_of(cut);
    EXPECT_GT(glm::length(next.force), 0.0);
    EXPECT_LE(glm::length(next.force), 200.0 * 0.002);
  }
}

TEST(HandStepper, TakesAnOldSampleForAFault) {
  double t = 0.0;
  HandStepper stepper = held(t, {.stale_after = 0.05});
  HandInput input = at(t, kNear);
  for (int i = 1; i <= 60; ++i) {
    input.time = t + 0.001 * i;
    const HandStep step = stepper.step(input);
    EXPECT_EQ(step.cut, i <= 50 ? ForceCut::kNone : ForceCut::kStale) << i;
  }
}

TEST(HandStepper, ForgetsItsProxiesWhenTheHandLetsGo) {
  double t = 0.0;
  HandStepper stepper = held(t);
  const HandStep away = stepper.step({.time = t + 0.001});
  EXPECT_FALSE(away.present);
  EXPECT_EQ(away.force, Vec3(0.0));
  EXPECT_EQ(away.state, HoldState::kFree);
  EXPECT_EQ(away.chain.links, 0);
  EXPECT_EQ(away.cut, ForceCut::kNoHand);
  // Far away, where a chain that still held would have jumped.
  const HandStep back = stepper.step(at(t + 0.002, {1, 0, 0}));
  EXPECT_EQ(back.cut, ForceCut::kStart) << "another hand starts from zero";
  EXPECT_FALSE(back.chain.jumped);
}

TEST(HandStepper, LetsTheForceFadeWhereSamplesStopOrTheButtonIsReleased) {
  constexpr double kStep = 1.0 / 1024.0;  // ages are exact
  constexpr int kHeld = 100, kOld = 20, kFade = 50;
  const DeviceLimits limits{.stale_after = kOld * kStep, .fade_time = kFade * kStep, .enabling_button = 0};
  const double whole = 200.0 * 0.002;
  for (const bool stale : {true, false}) {
    HandStepper stepper(sphere_chain(kRadius), limits);
    HandInput input;
    const int last = kHeld + (stale ? kOld : 0);  // step with the whole force
    for (int i = 0; i <= last + kFade; ++i) {
      input.time = kStep * i;
      input.present = true;
      if (i <= kHeld || !stale) input.sample = {input.time, kNear, i <= kHeld ? 1U : 0U};
      const HandStep step = stepper.step(input);
      const double part = std::clamp(1.0 - static_cast<double>(i - last) / kFade, 0.0, 1.0);
      if (i >= kHeld) {
        ASSERT_NEAR(glm::length(step.force), whole * part, 1e-12) << i;
      }
      if (i <= last) continue;
      EXPECT_EQ(step.cut, stale ? ForceCut::kStale : ForceCut::kReleased);
      EXPECT_EQ(step.state, stale ? HoldState::kFault : HoldState::kHeld);
    }
  }
}

// What is felt when a force is switched on, a hand comes back or a chain is changed, all deep in a wall.
TEST(HandStepper, StartsWithASmallForceEachTime) {
  constexpr double kRamp = 0.5, kCap = 4.0;
  const Vec3 deep{0.0, 0.0, 0.059};
  HandStepper stepper(sphere_chain(kRadius, {.stiffness = 2000.0}),
                      {.force_cap = kCap, .slew_cap = 1e5, .start_ramp = kRamp});
  double t = 0.0;
  const auto start = [&](const char* what) {
    for (int i = 0; i <= 600; ++i) {
      t += 0.001;
      const double force = glm::length(stepper.step(at(t, deep)).force);
      ASSERT_NEAR(force, kCap * std::min(1.0, 0.001 * i / kRamp), 1e-6) << what << ", step " << i;
    }
  };
  start("first");
  stepper.apply(HandSwitch::kForceOff);
  (void)stepper.step(at(t += 0.001, deep));
  stepper.apply(HandSwitch::kArm);
  start("armed");
  stepper.apply(HandSwitch::kRestart);
  start("after a stall");
  (void)stepper.step({.time = t += 0.001});
  start("another hand");
  (void)stepper.exchange_chain(sphere_chain(kRadius, {.stiffness = 2000.0}));
  start("another chain");
}

/// A chain that drags the hand.
class Drag final : public Constraint {
 public:
  void apply(const ChainSettings& /*settings*/) noexcept override {}
  void reset() noexcept override {}
  void update(const Vec3& probe, const UpdateBudget& /*budget*/, LinkUpdate& link) noexcept override {
    link.proxy = probe;
    link.damping = {5.0, 5.0, 0.0};
  }
};

TEST(HandStepper, DragsAMovingHandAgainstItsVelocityOnly) {
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::make_unique<Drag>());
  HandStepper stepper(std::make_unique<ProxyChain>(std::move(links), ChainSettings{}), {});
  HandStep step;
  const Vec3 velocity{0.1, 0.0, 0.2};
  for (int i = 0; i < 200; ++i) step = stepper.step(at(0.001 * i, velocity * (0.001 * i)));
  EXPECT_NEAR(glm::distance(step.force, Vec3(-0.5, 0.0, 0.0)), 0.0, 1e-6);
}

TEST(HandStepper, StartsFromZeroWhereAFeatureChanges) {
  double t = 0.0;
  HandStepper stepper = held(t);
  const HandStep jump = stepper.step(at(t + 0.001, {0, 0, 0.2}));
  EXPECT_EQ(jump.state, HoldState::kReleased);
  EXPECT_EQ(jump.cut, ForceCut::kJump);
  EXPECT_EQ(jump.force, Vec3(0.0));
}

TEST(HandStepper, StartsFromZeroWithAnotherChainAndKeepsTheForceOnAnEditedStiffness) {
  double t = 0.0;
  HandStepper stepper = held(t);
  ChainSettings softer;
  softer.stiffness = 199.0;
  stepper.apply(softer);
  EXPECT_NEAR(stepper.step(at(t + 0.001, kNear)).force.z, -199.0 * 0.002, 1e-12);
  softer.stiffness = kNan;
  stepper.apply(softer);
  EXPECT_NEAR(stepper.step(at(t + 0.002, kNear)).force.z, -199.0 * 0.002, 1e-12) << "nonsense is ignored";
  const auto old = stepper.exchange_chain(sphere_chain(0.055));
  EXPECT_EQ(old->settings().stiffness, 199.0);
  const HandStep first = stepper.step(at(t + 0.003, kNear));
  EXPECT_EQ(first.cut, ForceCut::kStart);
  EXPECT_NEAR(first.chain.proxies[0].z, 0.055, 1e-15);
  EXPECT_NEAR(stepper.step(at(t + 0.004, kNear)).force.z, 0.2, 1e-12);
}

TEST(HandStepper, SwitchesForceOff) {
  double t = 0.0;
  HandStepper stepper = held(t);
  stepper.apply(HandSwitch::kForceOff);
  const HandStep off = stepper.step(at(t + 0.001, {0, 0.051, 0}));
  EXPECT_EQ(off.cut, ForceCut::kSwitchedOff);
  EXPECT_EQ(off.state, HoldState::kHeld) << "proxies go on without force";
  EXPECT_NEAR(off.chain.proxies[0].y, kRadius, 1e-15);
  stepper.apply(HandSwitch::kArm);
  EXPECT_EQ(stepper.step(at(t + 0.002, kNear)).cut, ForceCut::kStart);
  EXPECT_GT(glm::length(stepper.step(at(t + 0.003, kNear)).force), 0.0);
}

TEST(HandStepper, LatchesWhenTheHandPassesTheVelocityGate) {
  double t = 0.0;
  HandStepper stepper = held(t, {.velocity_gate = 1.0});
  const auto moved = [&](double seconds, double way) {
    return stepper.step(at(t + seconds, kNear + Vec3{way, 0, 0}));
  };
  // 0.9 m/s for long, then 1.2 m/s: over the window that is seen within the window.
  int n = 1;
  for (; n <= 50; ++n) ASSERT_NE(moved(0.001 * n, 0.0009 * n).cut, ForceCut::kTooFast) << n;
  HandStep fast;
  const int began = n;
  for (; n < began + 12 && fast.cut != ForceCut::kTooFast; ++n) {
    fast = moved(0.001 * n, 0.0009 * began + 0.0012 * (n - began));
  }
  EXPECT_EQ(fast.cut, ForceCut::kTooFast);
  EXPECT_EQ(fast.state, HoldState::kFault);
  EXPECT_EQ(moved(0.001 * n, 0.0).cut, ForceCut::kTooFast);
  for (int rest = 1; rest <= 12; ++rest) (void)moved(0.001 * (n + rest), 0.0);
  stepper.apply(HandSwitch::kArm);
  EXPECT_EQ(moved(0.001 * (n + 12.5), 0.0).cut, ForceCut::kStart);
  EXPECT_EQ(moved(0.001 * (n + 13), 0.0).cut, ForceCut::kNone);
}

// Two packets that come together are no speed, a step of an encoder is none, a leap is one at once.
TEST(HandStepper, JudgesTheSpeedOverAWindow) {
  constexpr double kGate = 1.5;
  for (const double apart : {0.00001, 0.00067, 0.001}) {
    double t = 0.0;
    HandStepper stepper = held(t, {.velocity_gate = kGate});
    // Half a metre a second, sent in pairs.
    for (int n = 1; n <= 100; ++n) {
      const double pair = t + 0.002 * n;
      ASSERT_NE(stepper.step(at(pair, kNear + Vec3{0.001 * n, 0, 0})).cut, ForceCut::kTooFast) << apart;
      ASSERT_NE(stepper.step(at(pair + apart, kNear + Vec3{0.001 * n + 0.001, 0, 0})).cut,
                ForceCut::kTooFast);
    }
  }
  for (const auto& [leap, fast] : {std::pair{0.0149, false}, std::pair{0.0151, true}}) {
    double t = 0.0;
    HandStepper stepper = held(t, {.velocity_gate = kGate});
    EXPECT_EQ(stepper.step(at(t + 0.001, kNear + Vec3{leap, 0, 0})).cut == ForceCut::kTooFast, fast) << leap;
  }
  // A tracker that is slower than the window: from sample to sample.
  for (const auto& [step, fast] : {std::pair{0.024, false}, std::pair{0.026, true}}) {
    double t = 0.0;
    HandStepper stepper = held(t, {.velocity_gate = kGate});
    HandStep last;
    for (int n = 1; n <= 3; ++n) last = stepper.step(at(t + n / 60.0, kNear + Vec3{step * n, 0, 0}));
    EXPECT_EQ(last.cut == ForceCut::kTooFast, fast) << step;
  }
  // A clock that was set forward and back does not close the eye of the gate.
  double t = 0.0;
  HandStepper stepper = held(t, {.velocity_gate = kGate});
  HandInput ahead = at(t + 0.001, kNear);
  ahead.sample.time = 1e9;
  (void)stepper.step(ahead);
  HandStep last;
  for (int n = 2; n <= 20; ++n) last = stepper.step(at(t + 0.001 * n, kNear + Vec3{0.002 * n, 0, 0}));
  EXPECT_EQ(last.cut, ForceCut::kTooFast);
}

// Reach and gate are the device's, in its own frame, wherever and how large it is laid over the workspace.
TEST(HandStepper, JudgesTheHandInItsOwnFrame) {
  const DeviceLimits limits{
      .velocity_gate = 1.0, .reach_lower = Vec3{-0.05}, .reach_upper = Vec3{0.05}, .edge_stiffness = 0.0};
  for (const double scale : {0.1, 10.0}) {
    HandStepper stepper(sphere_chain(kRadius), limits);
    const auto cut_after = [&](double start, double speed) {
      HandStep step;
      for (int n = 0; n < 30; ++n) {
        const Vec3 hand{-0.02 + speed * 0.001 * n, 0.0, 0.0};
        HandInput input = at(start + 0.001 * n, kNear + scale * hand);
        input.sample.hand = hand;
        step = stepper.step(input);
      }
      (void)stepper.step({.time = start + 0.05});
      return step.cut;
    };
    EXPECT_EQ(cut_after(0.0, 0.9), ForceCut::kNone) << scale;
    EXPECT_EQ(cut_after(0.1, 1.1), ForceCut::kTooFast) << scale;
    stepper.apply(HandSwitch::kArm);
    HandInput outside = at(0.2, kNear);
    outside.sample.hand = Vec3{0.051, 0.0, 0.0};
    EXPECT_EQ(stepper.step(outside).cut, ForceCut::kStart) << "the first step has none anyway";
    outside.time = outside.sample.time = 0.201;
    EXPECT_EQ(stepper.step(outside).cut, ForceCut::kOutOfReach) << scale;
    outside.time = outside.sample.time = 0.202;
    outside.sample.hand->x = std::nan("");
    EXPECT_EQ(stepper.step(outside).cut, ForceCut::kNotFinite) << scale;
  }
}

/// A chain that gives what is no number after a while.
class Broken final : public Constraint {
 public:
  void apply(const ChainSettings& /*settings*/) noexcept override {}
  void reset() noexcept override { ++resets; }
  void update(const Vec3& probe, const UpdateBudget& /*budget*/, LinkUpdate& link) noexcept override {
    link.proxy = probe / probe.x;
    link.state = HoldState::kHeld;
  }
  int resets = 0;
};

TEST(HandStepper, SurvivesAChainThatGivesNoNumber) {
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::make_unique<Broken>());
  const auto& broken = static_cast<const Broken&>(*links.front());
  HandStepper stepper(std::make_unique<ProxyChain>(std::move(links), ChainSettings{}), {});
  (void)stepper.step(at(0.0, {1, 2, 3}));
  const HandStep step = stepper.step(at(0.001, {0, 2, 3}));
  EXPECT_EQ(step.cut, ForceCut::kNotFinite);
  EXPECT_EQ(step.force, Vec3(0.0));
  EXPECT_EQ(step.chain.proxies[0], Vec3(1, 2, 3)) << "the last finite ones";
  EXPECT_EQ(broken.resets, 1);
}

TEST(HandStepper, AllocatesNothingAndIsTheSameEachTime) {
  HandStepper a(sphere_chain(kRadius), {});
  HandStepper b(sphere_chain(kRadius), {});
  std::mt19937_64 random{3};
  std::uniform_real_distribution<double> unit(-0.1, 0.1);
  double t = 0.0;
  const AllocationGuard guard;
  for (int i = 0; i < 20'000; ++i) {
    t += 0.001;
    HandInput input = at(t, {unit(random), unit(random), unit(random)});
    if (random() % 50 == 0) input.present = false;
    if (random() % 50 == 0) input.time = kNan;
    if (random() % 50 == 0) input.sample.position.y = kInf;
    if (random() % 50 == 0) a.apply(HandSwitch::kRestart), b.apply(HandSwitch::kRestart);
    const HandStep first = a.step(input);
    const HandStep second = b.step(input);
    ASSERT_EQ(first.force, second.force);
    ASSERT_EQ(first.chain.proxies, second.chain.proxies);
    ASSERT_EQ(first.state, second.state);
    ASSERT_LE(glm::length(first.force), 4.0 * (1.0 + 1e-12));
  }
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace palpate::test
