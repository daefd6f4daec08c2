#include "common/device/simulated_arm.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

constexpr double kTick = 0.001;  // [s]
constexpr DeviceProfile kMass{.name = "mass", .mass = 0.1, .peak_force = 10.0};

TEST(SimulatedArm, HoldsACommandFromTheNextInstantToTheNextCommand) {
  SimulatedArm arm(kMass, kUnheld, 3.0, {0.01, 0.02, 0.03});
  EXPECT_EQ(arm.position(), Vec3(0.01, 0.02, 0.03));
  arm.command(3.0, {0.5, 0.0, -1.0});
  arm.advance(3.0 + kTick);
  EXPECT_NEAR(arm.velocity().x, 0.5 / 0.1 * kTick, 1e-15);
  EXPECT_NEAR(arm.position().z, 0.03 - 0.5 * 10.0 * kTick * kTick, 1e-17);
  arm.command(3.0 + kTick, Vec3{0.0});
  const double v = arm.velocity().x;
  arm.advance(3.0 + 3.0 * kTick);
  EXPECT_NEAR(arm.velocity().x, v, 1e-15);
}

// The loop sees the sum of both delays, in whichever of them it lies, to the instant and not to the tick.
TEST(SimulatedArm, DelaysByTheSumOfSensorsAndActuators) {
  for (const auto& [sensor, actuator] :
       {std::pair{0.0, 0.0}, {0.0027, 0.0}, {0.0, 0.0027}, {0.001, 0.0017}}) {
    DeviceProfile profile = kMass;
    profile.sensor_delay = sensor;
    profile.actuator_delay = actuator;
    SimulatedArm arm(profile, kUnheld, 0.0, Vec3{0.0});
    for (int n = 0; n < 20; ++n) {
      const double t = kTick * n;
      arm.advance(t);
      const double pushed = std::max(0.0, t - 0.005 - (sensor + actuator));
      EXPECT_NEAR(arm.encoders().x, 0.5 * 10.0 * pushed * pushed, 1e-15)
          << sensor << " " << actuator << " " << n;
      arm.command(t, n >= 5 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0});
    }
    EXPECT_NEAR(arm.time(), 0.019 - sensor, 1e-15);
  }
}

TEST(SimulatedArm, ShortensForcesToItsPeakAndKeepsTheirDirection) {
  SimulatedArm arm(kMass, kUnheld, 0.0, Vec3{0.0});
  arm.command(0.0, {30.0, 0.0, -40.0});
  arm.advance(kTick);
  EXPECT_NEAR(arm.motor_force().x, 6.0, 1e-14);
  EXPECT_NEAR(arm.motor_force().z, -8.0, 1e-14);
  arm.stop();
  arm.advance(2.0 * kTick);
  EXPECT_EQ(arm.motor_force(), Vec3(0.0));
}

TEST(SimulatedArm, StopsWhatIsUnderWayToo) {
  DeviceProfile profile = kMass;
  profile.actuator_delay = 0.003;
  SimulatedArm arm(profile, kUnheld, 0.0, Vec3{0.0});
  arm.command(0.0, Vec3{1.0});
  arm.advance(kTick);
  arm.stop();
  arm.advance(0.05);
  EXPECT_EQ(arm.position(), Vec3(0.0));
}

TEST(SimulatedArm, ShowsPositionsInStepsOfItsEncoders) {
  DeviceProfile profile = kMass;
  profile.encoder_step = 1e-4;
  const SimulatedArm arm(profile, kUnheld, 0.0, {1.49e-4, 1.51e-4, -1.51e-4});
  EXPECT_NEAR(arm.encoders().x, 1e-4, 1e-18);
  EXPECT_NEAR(arm.encoders().y, 2e-4, 1e-18);
  EXPECT_NEAR(arm.encoders().z, -2e-4, 1e-18);
  EXPECT_EQ(arm.position().x, 1.49e-4);
}

// A hand that pulls itself along, motors that work for and against it, friction and delays: nothing is lost.
TEST(SimulatedArm, KeepsItsEnergyBalanced) {
  for (const DeviceProfile& profile : device_profiles()) {
    for (const HandImpedance& hand : {kUnheld, kRelaxedHand, kFirmHand}) {
      std::mt19937 random{11};
      std::uniform_real_distribution<double> unit(-1.0, 1.0);
      SimulatedArm arm(profile, hand, 0.0, Vec3{0.0});
      double turned_over = 0.0;  // [J]
      for (int n = 1; n <= 2000; ++n) {
        arm.set_rest(0.01 * Vec3{unit(random), unit(random), unit(random)});
        arm.push(Vec3{unit(random), unit(random), unit(random)});
        arm.command(kTick * n, 3.0 * Vec3{unit(random), unit(random), unit(random)});
        const double before = arm.energy().motors;
        arm.advance(kTick * n);
        turned_over += std::abs(arm.energy().motors - before);
      }
      const ArmEnergy& e = arm.energy();
      const double in = e.motors + e.pushes + e.hand;
      const double kinetic = 0.5 * (profile.mass + hand.mass) * glm::dot(arm.velocity(), arm.velocity());
      const double out = e.viscous + e.friction + kinetic + arm.stored();
      EXPECT_NEAR(in, out, 1e-10 * (turned_over + std::abs(in))) << profile.name << " " << hand.stiffness;
      EXPECT_GE(e.viscous, 0.0);
      EXPECT_GE(e.friction, 0.0);
      EXPECT_GT(turned_over, 0.0);
    }
  }
}

TEST(SimulatedArm, StandsThroughAPauseOfItsReader) {
  SimulatedArm arm(kMass, kUnheld, 0.0, Vec3{0.0});
  arm.command(0.0, {1.0, 0.0, 0.0});
  arm.advance(1000.0);
  EXPECT_EQ(arm.time(), 1000.0);
  EXPECT_NEAR(arm.velocity().x, 10.0 * SimulatedArm::kLongestGap, 1e-9);
}

TEST(SimulatedArm, AllocatesNothing) {
  SimulatedArm arm(find_profile("falcon"), kFirmHand, 0.0, Vec3{0.0});
  const AllocationGuard guard;
  for (int n = 0; n < 1000; ++n) {
    arm.command(kTick * n, Vec3{std::sin(0.1 * n)});
    arm.advance(kTick * n);
  }
  EXPECT_EQ(guard.count(), 0U);
}

TEST(DeviceProfile, AreAllUsableAndKnownByName) {
  for (const DeviceProfile& profile : device_profiles()) {
    EXPECT_TRUE(profile.valid()) << profile.name;
    EXPECT_EQ(&find_profile(profile.name), &profile);
  }
  EXPECT_EQ(device_profiles().front().name, "premium3");
  try {
    (void)find_profile("omega");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "unknown simulated device 'omega'; known are premium3, falcon, ideal");
  }
}

}  // namespace
}  // namespace palpate::test
