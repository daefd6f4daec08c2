// Reference effects under hands that are known, and under devices that show them badly.

#include "apps/workbench/feel_score.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

constexpr double kStiffness = 500.0;  // [N/m]
constexpr double kPeriod = 1e-3;      // [s]

/// A hand that moves from a to b in `seconds`.
void move(HandStepper& stepper, FeelScore& score, double& time, const Vec3& a, const Vec3& b,
          double seconds) {
  const auto steps = static_cast<int>(seconds / kPeriod);
  for (int i = 1; i <= steps; ++i) {
    time += kPeriod;
    const Vec3 x = a + (b - a) * (static_cast<double>(i) / steps);
    score.add(stepper.step({.time = time, .present = true, .sample = {time, x, 0}}));
  }
}

/// In and out of the effect along z at 25 mm/s, 5 mm deep.
FeelScore pressed(FeelEffect effect, const DeviceLimits& limits, const Vec3& from, const Vec3& to) {
  HandStepper stepper(feel_chain(effect, kStiffness, 0.0), limits);
  FeelScore score(kStiffness);
  double time = 0.0;
  move(stepper, score, time, from, to, 0.4);
  move(stepper, score, time, to, from, 0.4);
  return score;
}

bool holds(const FeelScore& score, const std::string& name) {
  for (const StabilityCase& c : score.cases()) {
    if (c.row.name == name) return c.row.holds;
  }
  ADD_FAILURE() << "no case " << name;
  return false;
}

TEST(FeelScore, JudgesAWallThatIsShownTruly) {
  const FeelScore score = pressed(FeelEffect::kWall, {}, {0.01, 0.0, 0.005}, {0.01, 0.0, -0.005});
  EXPECT_NEAR(score.deepest(), 0.005, 1e-12);
  EXPECT_NEAR(score.largest_force(), 0.005 * kStiffness, 1e-9);
  EXPECT_NEAR(score.haptic_stiffness(), kStiffness, 1.0);
  EXPECT_EQ(score.free_force(), 0.0);
  EXPECT_LT(score.leak(), 1e-12);
  // In and out at constant speed the hold gives K v T p to the hand (devices are what takes it).
  const double speed = 0.01 / 0.4;
  EXPECT_NEAR(score.most_given(), kStiffness * speed * kPeriod * 0.005,
              0.03 * kStiffness * speed * kPeriod * 0.005);
  for (const StabilityCase& c : score.cases()) EXPECT_TRUE(c.row.holds) << c.row.name;
}

TEST(FeelScore, SeesAWallThatACapMakesSofter) {
  const FeelScore score =
      pressed(FeelEffect::kWall, {.force_cap = 1.0}, {0.0, 0.0, 0.005}, {0.0, 0.0, -0.005});
  EXPECT_NEAR(score.largest_force(), 1.0, 1e-12);
  EXPECT_LT(score.haptic_stiffness(), 0.6 * kStiffness);
  EXPECT_FALSE(holds(score, "stiffness shown"));
}

TEST(FeelScore, SeesAHandThatIsTooFast) {
  const FeelScore score =
      pressed(FeelEffect::kWall, {.velocity_gate = 0.01}, {0.0, 0.0, 0.005}, {0.0, 0.0, -0.005});
  EXPECT_GT(score.faults(), 0U);
  EXPECT_FALSE(holds(score, "steps with a fault"));
}

TEST(FeelScore, FindsGrooveAndSphereFreeAlongThem) {
  // Across the groove, 4 mm off it, and along it.
  HandStepper stepper(feel_chain(FeelEffect::kGroove, kStiffness, 0.0), {});
  FeelScore groove(kStiffness);
  double time = 0.0;
  move(stepper, groove, time, {0.0, 0.0, 0.0}, {0.0, 0.004, 0.0}, 0.2);
  move(stepper, groove, time, {0.0, 0.004, 0.0}, {0.05, 0.004, 0.0}, 0.5);
  EXPECT_NEAR(groove.largest_force(), 0.004 * kStiffness, 1e-6);
  EXPECT_LT(groove.leak(), 1e-9);
  const FeelScore sphere = pressed(FeelEffect::kSphere, {}, {0.0, 0.0, kFeelSphereRadius + 0.004},
                                   {0.0, 0.0, kFeelSphereRadius - 0.004});
  EXPECT_NEAR(sphere.largest_force(), 0.004 * kStiffness, 1e-6);
  EXPECT_LT(sphere.leak(), 1e-9);
}

// A force that lags behind as the hand goes round the sphere points aside.
TEST(FeelScore, SeesAForceThatPointsAside) {
  HandStepper stepper(feel_chain(FeelEffect::kSphere, kStiffness, 0.0), {.slew_cap = 2.0});
  FeelScore score(kStiffness);
  double time = 0.0;
  const double r = kFeelSphereRadius - 0.004;
  move(stepper, score, time, {0.0, 0.0, r}, {0.0, 0.0, r}, 2.0);
  Vec3 from{0.0, 0.0, r};
  for (int i = 1; i <= 8; ++i) {
    const double angle = 0.2 * i;
    const Vec3 to{r * std::sin(angle), 0.0, r * std::cos(angle)};
    move(stepper, score, time, from, to, 0.05);
    from = to;
  }
  EXPECT_GT(score.leak(), 0.1);
  EXPECT_FALSE(holds(score, "force along what is free"));
}

}  // namespace
}  // namespace palpate::test
