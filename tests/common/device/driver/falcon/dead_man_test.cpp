// The dead-man switch of an emulated Falcon in simulated time: from losing it to motors that rest.

#include <memory>

#include <gtest/gtest.h>

#include "common/device/driver/falcon/falcon_link.h"
#include "common/servo/linked_device.h"
#include "common/servo/safety_stage.h"
#include "tests/common/device/driver/falcon/falcon_emulator.h"
#include "tests/common/device/driver/round_with.h"
#include "tests/common/device/driver/transport/fake_usb.h"

namespace palpate::test {
namespace {

constexpr double kAllowed = 0.100;  // [s] from losing the switch to no force, the fade included
constexpr std::uint8_t kCentre = 4;

/// A hand that leans on a steady force, on a Falcon whose link and safety stage are worked in turn.
class DeadMan : public ::testing::Test {
 protected:
  DeadMan() {
    bus_.plug("1-2", falcon_);
    falcon_->set_target(FalconEmulator::kMiddle);
  }

  void step() {
    const double before = bus_.now();
    const Vec3 told = force_;
    (void)round_with(link_, told);
    const DeviceAtoms& atoms = link_.atoms();
    force_ = stage_.apply({.force = {0.0, 0.0, 2.0},
                           .dt = bus_.now() - before,
                           .age = bus_.now() - atoms.time,
                           .cut = atoms.time > 0.0 ? ForceCut::kNone : ForceCut::kNoHand,
                           .position = atoms.position,
                           .buttons = atoms.buttons});
  }
  void run(double seconds) {
    for (const double until = bus_.now() + seconds; bus_.now() < until;) step();
  }
  [[nodiscard]] bool pushes() const {
    const auto motors = falcon_->motors();
    return motors[0] != 0 || motors[1] != 0 || motors[2] != 0;
  }
  /// [s] until the motors rest.
  double time_to_rest() {
    const double lost = bus_.now();
    while (pushes() && bus_.now() < lost + 1.0) step();
    return bus_.now() - lost;
  }

  FakeUsb bus_;
  std::shared_ptr<FalconEmulator> falcon_ = std::make_shared<FalconEmulator>(
      EmulatedFalcon{.loaded = true, .homed = true, .start = FalconEmulator::kMiddle});
  FalconLink link_{bus_, {}};
  SafetyStage stage_{link_.limits()};
  Vec3 force_{0.0};
};

TEST_F(DeadMan, IsTheCentreButtonOfAFalconAndMustBeHeld) {
  EXPECT_EQ(link_.limits().enabling_button, 2);
  run(2.0);
  EXPECT_EQ(link_.status().phase, LinkPhase::kReady);
  EXPECT_EQ(falcon_->largest_motor(), 0) << "never held";
  falcon_->press(kCentre);
  run(1.0);
  EXPECT_TRUE(pushes());
  EXPECT_NEAR(force_.z, 2.0, 1e-9);
}

TEST_F(DeadMan, TakesTheForceAwayWithinTheTimeAllowed) {
  falcon_->press(kCentre);
  run(2.0);
  for (const std::uint8_t others : {0, 1, 2, 8, 11}) {
    ASSERT_TRUE(pushes());
    falcon_->press(others);
    const double rest = time_to_rest();
    RecordProperty("release_ms", std::to_string(1e3 * rest));
    EXPECT_LT(rest, kAllowed) << int{others};
    EXPECT_GT(rest, 0.5 * DeviceLimits{}.fade_time) << "it fades, the hand leans on it";
    run(0.3);
    EXPECT_FALSE(pushes()) << "nothing revives it";
    falcon_->press(kCentre);
    run(1.0);
  }
}

// Nothing comes from the device any more, its commands still arrive: what the button is, nobody knows.
TEST_F(DeadMan, TakesTheForceAwayWhereItsAnswersAreLost) {
  falcon_->press(kCentre);
  run(2.0);
  ASSERT_TRUE(pushes());
  bus_.set_faults({.lost_read = 1.0});
  EXPECT_LT(time_to_rest(), kAllowed);
}

// The stage alone, without the link's own defences: a button that is down for ever in data that grows old.
TEST_F(DeadMan, CountsTheTimeSinceTheButtonWasSeenWithTheFade) {
  DeviceLimits limits = link_.limits();
  limits.stale_after = 10.0;  // the rule of stale samples is another one
  SafetyStage stage(limits);
  const auto apply = [&](double age) {
    return stage.apply({.force = {0.0, 0.0, 2.0}, .dt = 0.001, .age = age, .buttons = kCentre}).z;
  };
  for (int i = 0; i < 1000; ++i) (void)apply(0.0);
  EXPECT_EQ(apply(0.0), 2.0);
  double age = 0.0;
  while (apply(age) > 0.0 && age < 1.0) age += 0.001;
  RecordProperty("stale_ms", std::to_string(1e3 * age));
  EXPECT_LT(age, kAllowed);
  EXPECT_EQ(stage.cut(), ForceCut::kReleased);
}

TEST(SwitchOfAnotherDevice, IsHeldOnlyWhileItIsDownAndFreshByItsOwnTime) {
  constexpr std::uint32_t kBit = 1U << static_cast<unsigned>(EnablingSwitch::kOtherBit);
  const DeviceAtoms down{.time = 5.0, .buttons = 0b10};
  EXPECT_EQ(with_switch(3, &down, 1, 5.0), 3U | kBit);
  EXPECT_EQ(with_switch(3, &down, 1, 5.0 + 0.99 * kEnablingStale), 3U | kBit);
  EXPECT_EQ(with_switch(3, &down, 1, 5.0 + 1.01 * kEnablingStale), 3U);
  EXPECT_EQ(with_switch(3, &down, 0, 5.0), 3U) << "another button of it";
  EXPECT_EQ(with_switch(3 | kBit, nullptr, 1, 5.0), 3U) << "the device's own last button is not it";
  EXPECT_EQ(with_switch(3 | kBit, &down, 0, 5.0), 3U);
}

}  // namespace
}  // namespace palpate::test
