// The Falcon's link against an emulated device in simulated time: loading, homing, forces, and every fault
// that a cable, a bridge or a user can cause. Whatever happens, no force is above the cap and none is left
// behind.

#include "common/device/driver/falcon/falcon_link.h"

#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/common/device/driver/falcon/falcon_emulator.h"
#include "tests/common/device/driver/round_with.h"
#include "tests/common/device/driver/soak.h"
#include "tests/common/device/driver/transport/fake_usb.h"

namespace palpate::test {
namespace {

constexpr const char* kPath = "1-2";

std::vector<std::uint8_t> random_image(std::size_t bytes) {
  std::mt19937 random{9};
  std::vector<std::uint8_t> image(bytes);
  for (std::uint8_t& byte : image) byte = static_cast<std::uint8_t>(random());
  return image;
}

class FalconLinkTest : public ::testing::Test {
 protected:
  void plug(const EmulatedFalcon& emulated, const FalconSettings& settings = {}) {
    falcon_ = std::make_shared<FalconEmulator>(emulated);
    bus_.plug(kPath, falcon_);
    link_ = std::make_unique<FalconLink>(bus_, settings);
  }
  void plug_ready() {
    plug({.loaded = true, .homed = true});
    ASSERT_TRUE(run_until(LinkPhase::kReady, 2.0));
  }

  using Force = std::function<Vec3(const DeviceAtoms&)>;
  void run(
      double seconds, const Force& force = [](const DeviceAtoms&) { return Vec3{0.0}; }) {
    for (const double until = bus_.now() + seconds; bus_.now() < until;) {
      (void)round_with(*link_, force(link_->atoms()));
    }
  }
  bool run_until(LinkPhase phase, double seconds) {
    for (const double until = bus_.now() + seconds; bus_.now() < until;) {
      const double began = bus_.now();
      (void)round_with(*link_, Vec3{0.0});
      EXPECT_LT(bus_.now() - began, DriverLink::kLongestRound);
      if (link_->status().phase == phase) return true;
    }
    return false;
  }
  [[nodiscard]] bool silent() const { return falcon_->motors() == std::array<int, 3>{}; }

  FakeUsb bus_;
  std::shared_ptr<FalconEmulator> falcon_;
  std::unique_ptr<FalconLink> link_;
};

Vec3 constant(const DeviceAtoms& /*atoms*/) { return {1.0, -0.5, 2.0}; }

TEST_F(FalconLinkTest, LoadsTheImageAndRuns) {
  const auto image = random_image(8101);
  plug({}, {.firmware = image});
  ASSERT_TRUE(run_until(LinkPhase::kNeedsHoming, 20.0)) << link_->advice();
  EXPECT_EQ(falcon_->image(), image);
  EXPECT_EQ(link_->status().uploads, 1U);
  // Running speed first; the loader's, with DTR low and high before the greeting and low after it; running.
  const auto& done = falcon_->controls();
  const auto find = [&](std::size_t from, std::pair<int, int> wanted) {
    while (from < done.size() && done[from] != wanted) ++from;
    return from;
  };
  std::size_t at = 0;
  for (const std::pair<int, int>& wanted : std::vector<std::pair<int, int>>{{0x09, 1},
                                                                            {0x03, 0x0002},
                                                                            {0x09, 16},
                                                                            {0x03, 0x4138},
                                                                            {0x04, 0x0008},
                                                                            {0x01, 0x0200},
                                                                            {0x01, 0x0100},
                                                                            {0x01, 0x0101},
                                                                            {0x01, 0x0100},
                                                                            {0x03, 0x0015},
                                                                            {0x09, 1},
                                                                            {0x03, 0x0002}}) {
    at = find(at, wanted);
    ASSERT_LT(at, done.size()) << wanted.first << " " << wanted.second;
  }
}

TEST_F(FalconLinkTest, TriesAgainWhereTheEchoIsWrong) {
  plug({.failing_uploads = 3}, {.firmware = random_image(2000)});
  ASSERT_TRUE(run_until(LinkPhase::kNeedsHoming, 30.0));
  EXPECT_EQ(link_->status().uploads, 4U);
}

TEST_F(FalconLinkTest, LoadsWithoutClearToSend) {
  plug({.raises_cts = false}, {.firmware = random_image(1500)});
  EXPECT_TRUE(run_until(LinkPhase::kNeedsHoming, 20.0));
}

TEST_F(FalconLinkTest, SaysThatFirmwareIsMissing) {
  plug({});
  ASSERT_TRUE(run_until(LinkPhase::kNeedsFirmware, 5.0));
  EXPECT_NE(link_->advice().find("firmware=FILE"), std::string::npos);
  EXPECT_EQ(link_->status().uploads, 0U);
  plug({.deaf_loader = true}, {.firmware = random_image(1500)});
  ASSERT_TRUE(run_until(LinkPhase::kNeedsFirmware, 60.0));
  EXPECT_EQ(link_->status().uploads, static_cast<std::uint64_t>(FalconLink::kMostUploads));
}

// What is written where this program is killed: a command of no force.
TEST_F(FalconLinkTest, LeavesACommandOfZeroBehind) {
  plug({.loaded = true, .homed = true, .start = FalconEmulator::kMiddle});
  ASSERT_TRUE(run_until(LinkPhase::kReady, 5.0));
  const auto& [endpoint, word] = bus_.last_word();
  EXPECT_EQ(endpoint, 0x02);
  ASSERT_EQ(word.size(), 16U);
  EXPECT_EQ(word.front(), 0x3C);
  EXPECT_EQ(word.back(), 0x3E);
  for (std::size_t i = 1; i <= 12; ++i) EXPECT_EQ(word[i], 0x41) << i;
  EXPECT_EQ(link_->advice(), "");
  bus_.set_guardian(false);
  plug({.loaded = true, .homed = true, .start = FalconEmulator::kMiddle});
  ASSERT_TRUE(run_until(LinkPhase::kReady, 5.0));
  EXPECT_NE(link_->advice().find("guardian"), std::string::npos);
}

TEST_F(FalconLinkTest, ShowsNoForceBeforeAllEncodersHaveTheirZero) {
  plug({.loaded = true});
  falcon_->home_by_itself(false);
  run(1.0, constant);
  EXPECT_EQ(link_->status().phase, LinkPhase::kNeedsHoming);
  EXPECT_EQ(falcon_->largest_motor(), 0);
  falcon_->home_by_itself(true);
  // A force is asked for all the time, over the jump of each encoder's zero, too.
  for (double until = bus_.now() + 5.0; bus_.now() < until && link_->status().phase != LinkPhase::kReady;) {
    (void)round_with(*link_, {0.0, 0.0, 5.0});
  }
  ASSERT_EQ(link_->status().phase, LinkPhase::kReady);
  run(0.5, constant);
  EXPECT_FALSE(falcon_->pushed_unhomed());
  EXPECT_GT(falcon_->largest_motor(), 0);
}

TEST_F(FalconLinkTest, SeesTheHandToAnEncoderStep) {
  plug_ready();
  std::mt19937 random{6};
  std::uniform_real_distribution<double> side{-0.03, 0.03};
  constexpr double kStep = 6e-5;  // [m] half a count on each encoder, seen along the worst direction
  for (int n = 0; n < 20; ++n) {
    falcon_->set_target(FalconEmulator::kMiddle + Vec3{side(random), side(random), side(random)});
    run(0.25);
    // Where it stood when the answer was made, some milliseconds ago.
    const double moved = 0.004 * glm::length(falcon_->velocity());
    ASSERT_LT(glm::distance(link_->atoms().position + FalconSettings::kMiddle, falcon_->position()),
              kStep + moved);
  }
  falcon_->press(0x5);
  run(0.02);
  EXPECT_EQ(link_->atoms().buttons, 5U);
}

// The emulator turns motor commands into a force by kinematics of its own.
TEST_F(FalconLinkTest, ShowsTheForceThatIsAskedFor) {
  plug_ready();
  std::mt19937 random{8};
  std::uniform_real_distribution<double> part{-1.5, 1.5};
  for (int n = 0; n < 50; ++n) {
    const Vec3 force{part(random), part(random), part(random)};
    run(0.05, [&](const DeviceAtoms&) { return force; });
    ASSERT_LT(glm::distance(falcon_->motor_force(), force), 0.02) << n;
  }
}

TEST_F(FalconLinkTest, ShortensWhatIsTooMuchAndKeepsItsDirection) {
  plug_ready();
  const Vec3 huge{0.0, 0.0, -500.0};
  run(0.05, [&](const DeviceAtoms&) { return huge; });
  EXPECT_LE(glm::length(falcon_->motor_force()), 8.0 + 0.02);
  EXPECT_GT(glm::length(falcon_->motor_force()), 7.0);
  EXPECT_LT(glm::dot(glm::normalize(falcon_->motor_force()), glm::normalize(huge)) - 1.0, 1e-3);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const Vec3& bad : {Vec3{kNan}, Vec3{HUGE_VAL, 0, 0}}) {
    run(0.02, [&](const DeviceAtoms&) { return bad; });
    EXPECT_TRUE(silent());
  }
  run(0.02, [](const DeviceAtoms&) { return Vec3{1e200, 0.0, 0.0}; });
  EXPECT_LE(glm::length(falcon_->motor_force()), 8.0 + 0.02);
}

TEST_F(FalconLinkTest, KeepsOneCommandUnderWayAtItsRate) {
  plug_ready();
  const std::uint64_t before = link_->status().rounds;
  run(4.0, constant);
  const double rate = static_cast<double>(link_->status().rounds - before) / 4.0;
  EXPECT_GT(rate, 450.0);
  EXPECT_LE(falcon_->answers_waiting(), 1U);
  EXPECT_EQ(link_->status().lost, 0U);
  EXPECT_EQ(link_->status().faults, 0U);
}

TEST_F(FalconLinkTest, LeavesNoForceWhenItIsClosed) {
  plug_ready();
  run(0.1, constant);
  ASSERT_FALSE(silent());
  link_.reset();
  falcon_->read(bus_.now() + 0.1, 0x81, {});
  EXPECT_TRUE(silent());
  EXPECT_EQ(bus_.open_connections(), 0);
}

TEST_F(FalconLinkTest, TheLastCommandOnAnyFaultIsZero) {
  // Reads that vanish: the device still hears.
  plug_ready();
  run(0.1, constant);
  bus_.set_faults({.lost_read = 1.0});
  run(0.2, constant);
  EXPECT_TRUE(silent());
  EXPECT_GE(link_->status().faults, 1U);
  // And once the cable is good again all begins anew, without being asked.
  bus_.set_faults({});
  ASSERT_TRUE(run_until(LinkPhase::kReady, 3.0));

  // A zero that was lost: encoders jump, and say so.
  run(0.1, constant);
  ASSERT_FALSE(silent());
  falcon_->home_by_itself(false);
  falcon_->lose_zero();
  run(0.05, constant);
  EXPECT_EQ(link_->status().phase, LinkPhase::kNeedsHoming);
  EXPECT_TRUE(silent());
}

TEST_F(FalconLinkTest, GivesUpWhereEncodersJumpAsNoHandDoes) {
  plug_ready();
  run(0.1, constant);
  falcon_->slip(1, 3000);
  (void)round_with(*link_, constant({}));
  (void)round_with(*link_, constant({}));
  EXPECT_GT(link_->status().implausible, 0U);
  run(0.05, constant);
  EXPECT_TRUE(silent());
  EXPECT_EQ(link_->status().faults, 1U);
}

TEST_F(FalconLinkTest, NoticesWithinATenthOfASecondThatItIsUnplugged) {
  for (int n = 0; n < 10; ++n) {
    plug_ready();
    run(0.05 + 0.0007 * n, constant);
    const double pulled = bus_.now();
    bus_.unplug(kPath);
    while (link_->status().phase == LinkPhase::kReady && bus_.now() < pulled + 1.0)
      (void)round_with(*link_, {0, 0, 1});
    EXPECT_LT(bus_.now() - pulled, 0.1);
    EXPECT_EQ(bus_.open_connections(), 0);
    falcon_->restart();
    bus_.plug(kPath, falcon_);
    (void)run_until(LinkPhase::kNeedsFirmware, 3.0);
    EXPECT_EQ(link_->status().phase, LinkPhase::kNeedsFirmware);  // power was off, too
    link_.reset();
  }
}

TEST_F(FalconLinkTest, SaysWhyItCannotBeOpened) {
  bus_.refuse(TransferStatus::kDenied);
  plug({.loaded = true, .homed = true});
  run(0.1);
  EXPECT_EQ(link_->status().phase, LinkPhase::kRefused);
  EXPECT_NE(link_->advice().find("denied"), std::string::npos);
  bus_.refuse(TransferStatus::kBusy);
  run(1.0);
  EXPECT_NE(link_->advice().find("another program"), std::string::npos);
  bus_.refuse(TransferStatus::kOk);
  EXPECT_TRUE(run_until(LinkPhase::kReady, 2.0));
}

TEST_F(FalconLinkTest, RefusesSettingsThatMakeNoSense) {
  FalconSettings settings;
  EXPECT_TRUE(settings.valid());
  settings.firmware = random_image(100);
  EXPECT_FALSE(settings.valid());
  settings.firmware = random_image(70000);
  EXPECT_FALSE(settings.valid());
  settings = {};
  settings.gain = 0.0;
  EXPECT_FALSE(settings.valid());
}

// All that can go wrong, over and over, for as long as PALPATE_SOAK_SECONDS says [s of simulated time].
TEST_F(FalconLinkTest, BearsEveryFaultForLong) {
  const double seconds = soak_seconds(30.0);
  const auto image = random_image(1200);
  plug({.failing_uploads = 1}, {.firmware = image});
  Soak soak(21);
  std::uint64_t ready_rounds = 0, last_rounds = 0;
  while (bus_.now() < seconds && !HasFailure()) {
    soak.begin();
    bus_.set_faults({.lost_write = soak.rate(0.3),
                     .short_write = soak.rate(0.3),
                     .lost_read = soak.rate(0.3),
                     .corrupt_read = soak.rate(0.3),
                     .late_read = soak.rate(0.3),
                     .stall = soak.rate(0.1),
                     .timeout = soak.rate(0.1),
                     .lateness = 0.02 * soak.part(),
                     .seed = soak.seed()});
    if (soak.chance(0.05)) bus_.unplug_at_transfer(1 + soak.below(300));
    if (soak.chance(0.02)) falcon_->lose_zero();
    if (soak.chance(0.02)) falcon_->restart();
    falcon_->set_target(FalconEmulator::kMiddle + soak.within(0.03));
    // Where no answer is in force there is no new force either: at most the last command's until it is
    // cleared.
    ready_rounds += soak.work(
        *link_, [&] { return bus_.now(); }, 0.5, soak.force(15.0), [&] { return bus_.open_connections(); });
    ASSERT_LE(falcon_->largest_motor(), kFalconLargestCommand);
    if (bus_.devices().empty()) {
      (void)round_with(*link_, {0, 0, 0});
      ASSERT_NE(link_->status().phase, LinkPhase::kReady);
      ASSERT_EQ(bus_.open_connections(), 0);
      bus_.plug(kPath, falcon_);
    }
    last_rounds = link_->status().rounds;
  }
  EXPECT_GT(ready_rounds, static_cast<std::uint64_t>(50.0 * seconds));
  EXPECT_GT(link_->status().faults, 0U);
  EXPECT_GT(link_->status().opened, 1U);
  EXPECT_GT(last_rounds, 0U);
  // At the end: a good cable, and it works as on the first day.
  bus_.set_faults({});
  ASSERT_TRUE(run_until(LinkPhase::kReady, 30.0)) << link_->advice();
  link_.reset();
  falcon_->read(bus_.now() + 0.1, 0x81, {});
  EXPECT_TRUE(silent());
  EXPECT_EQ(bus_.open_connections(), 0);
}

}  // namespace
}  // namespace palpate::test
