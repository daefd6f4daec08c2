// The SpaceMouse family, reports and link, against an emulated one in simulated time.

#include <array>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/device/driver/spacemouse/spacemouse_link.h"
#include "common/device/driver/transport/usb_search.h"
#include "tests/common/device/driver/round_with.h"
#include "tests/common/device/driver/soak.h"
#include "tests/common/device/driver/spacemouse/spacemouse_emulator.h"
#include "tests/common/device/driver/transport/fake_usb.h"
#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

using Axes = std::array<double, 6>;
constexpr std::array<double, 6> kPlain{1.0, 1.0, 1.0, 1.0, 1.0, 1.0};

SpaceMouseState after(const std::vector<std::vector<std::uint8_t>>& reports) {
  SpaceMouseState state;
  for (const auto& report : reports) (void)take_report(report, state);
  return state;
}

TEST(SpaceMouseReport, TellsLayoutsApartByTheirLength) {
  const SpaceMouseState apart = after({{1, 0x5E, 0x01, 0x00, 0x00, 0xA2, 0xFE}, {2, 1, 0, 2, 0, 3, 0}});
  const SpaceMouseState together = after({{1, 0x5E, 0x01, 0x00, 0x00, 0xA2, 0xFE, 1, 0, 2, 0, 3, 0}});
  EXPECT_EQ(apart.raw, (std::array<std::int16_t, 6>{350, 0, -350, 1, 2, 3}));
  EXPECT_EQ(together.raw, apart.raw);
}

// Raw: x right, y towards the user, z down. The suite: x right, y up, z towards the user.
TEST(SpaceMouseReport, TurnsItsAxesIntoThoseOfTheSuite) {
  const auto axes = [](std::array<std::int16_t, 6> raw) { return valuators_of({.raw = raw}, kPlain); };
  EXPECT_EQ(axes({350, 0, 0, 0, 0, 0}), (Axes{1, 0, 0, 0, 0, 0}));
  EXPECT_EQ(axes({0, 350, 0, 0, 0, 0}), (Axes{0, 0, 1, 0, 0, 0}));
  EXPECT_EQ(axes({0, 0, -175, 0, 0, 0}), (Axes{0, 0.5, 0, 0, 0, 0}));
  EXPECT_EQ(axes({0, 0, 0, 0, 0, 350}), (Axes{0, 0, 0, 0, -1, 0}));
  EXPECT_EQ(axes({420, -32768, 0, 0, 0, 0}), (Axes{1, 0, -1, 0, 0, 0})) << "clamped";
  EXPECT_EQ(axes({4, -4, 3, 0, 1, -1}), (Axes{})) << "at rest";
}

TEST(SpaceMouseReport, KeepsSparseButtonsWhereTheyAre) {
  EXPECT_EQ(after({{3, 0x02}}).buttons, 2U);
  EXPECT_EQ(after({{3, 0x01, 0xF0, 0x40, 0x04, 0xFF, 0xFF}}).buttons, 0x0440F001U);
  EXPECT_EQ(after({{3, 0xFF, 0xFF}, {3, 0x00, 0x00}}).buttons, 0U);
}

TEST(SpaceMouseReport, IgnoresWhatIsNone) {
  SpaceMouseState state{.raw = {1, 2, 3, 4, 5, 6}, .buttons = 7};
  const std::vector<std::vector<std::uint8_t>> others{
      {}, {0x17, 1, 2, 3, 4, 5, 6, 7, 8}, {1}, {1, 2, 3, 4, 5, 6}, {2, 0}, {3}, {4, 1, 1, 1, 1, 1, 1}};
  for (const auto& report : others) EXPECT_EQ(take_report(report, state), SpaceMouseNews::kNothing);
  EXPECT_EQ(state.raw, (std::array<std::int16_t, 6>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(state.buttons, 7U);
}

TEST(SpaceMouseReport, SurvivesAnyBytes) {
  std::mt19937 random{5};
  SpaceMouseState state;
  std::array<std::uint8_t, 64> report{};
  const AllocationGuard guard;
  for (int n = 0; n < 200'000; ++n) {
    for (std::uint8_t& byte : report) byte = static_cast<std::uint8_t>(random());
    report[0] %= 5;
    (void)take_report(std::span(report).first(random() % 65), state);
    for (const double v : valuators_of(state, kPlain)) ASSERT_LE(std::abs(v), 1.0);
  }
  EXPECT_EQ(guard.count(), 0U);
}

class SpaceMouseLinkTest : public ::testing::Test {
 protected:
  void plug(UsbId id = {0x046d, 0xc626}, bool together = false) {
    mouse_ = std::make_shared<SpaceMouseEmulator>(id, together);
    bus_.plug("1-4", mouse_);
    link_ = std::make_unique<SpaceMouseLink>(bus_, settings_);
    run(0.05);
  }
  void run(double seconds) {
    for (const double until = bus_.now() + seconds; bus_.now() < until;) (void)round_with(*link_, Vec3{0.0});
  }
  [[nodiscard]] const Axes& axes() const { return link_->atoms().valuators; }

  FakeUsb bus_;
  SpaceMouseSettings settings_;
  std::shared_ptr<SpaceMouseEmulator> mouse_;
  std::unique_ptr<SpaceMouseLink> link_;
};

TEST_F(SpaceMouseLinkTest, FollowsTheCapInBothLayouts) {
  for (const bool together : {false, true}) {
    plug(together ? UsbId{0x256f, 0xc62f} : UsbId{0x046d, 0xc626}, together);
    ASSERT_EQ(link_->status().phase, LinkPhase::kReady);
    mouse_->deflect({175, -350, 70, 35, 0, 0});
    run(0.2);
    EXPECT_EQ(axes(), (Axes{0.5, -0.2, -1.0, 0.1, 0.0, 0.0})) << together;
    mouse_->deflect({});
    run(0.03);
    EXPECT_EQ(axes(), Axes{});
    mouse_->press(0x401);
    run(0.03);
    EXPECT_EQ(link_->atoms().buttons, 0x401U);
    EXPECT_TRUE(link_->atoms().has_valuators);
    EXPECT_FALSE(link_->atoms().has_position);
  }
}

// A deflection that nobody takes back would let the probe drift for ever.
TEST_F(SpaceMouseLinkTest, IsAtRestWhereTheReportOfThatIsLost) {
  plug();
  mouse_->forget_rest(true);
  mouse_->deflect({350, 0, 0, 0, 0, 0});
  run(0.1);
  EXPECT_EQ(axes()[0], 1.0);
  mouse_->deflect({});
  run(0.025);
  EXPECT_EQ(axes()[0], 1.0);
  run(SpaceMouseLink::kSilence);
  EXPECT_EQ(axes(), Axes{});
}

TEST_F(SpaceMouseLinkTest, IsAtRestOnceItIsUnplugged) {
  plug();
  mouse_->deflect({350, 0, 0, 0, 0, 0});
  run(0.1);
  const double pulled = bus_.now();
  bus_.unplug("1-4");
  while (link_->status().phase == LinkPhase::kReady) (void)round_with(*link_, Vec3{0.0});
  EXPECT_LT(bus_.now() - pulled, 0.1);
  EXPECT_EQ(axes(), Axes{});
  EXPECT_EQ(bus_.open_connections(), 0);
  bus_.plug("1-5", mouse_);
  run(0.3);
  EXPECT_EQ(link_->status().phase, LinkPhase::kReady);
  EXPECT_EQ(axes()[0], 1.0);
}

TEST_F(SpaceMouseLinkTest, LightsUpWhileItIsUsed) {
  plug();
  EXPECT_EQ(mouse_->light(), 1);
  link_.reset();
  EXPECT_EQ(mouse_->light(), 0);
  EXPECT_EQ(mouse_->bad_controls(), 0);
}

TEST_F(SpaceMouseLinkTest, IgnoresStrangeReportsAndOtherDevices) {
  plug({0x256f, 0xc650});  // a CadMouse, which is none of the family
  EXPECT_EQ(link_->status().phase, LinkPhase::kAbsent);
  plug();
  mouse_->say({0x17, 9, 9, 9, 9, 9, 9, 9});
  run(0.05);
  EXPECT_EQ(axes(), Axes{});
  EXPECT_GT(link_->status().dropped, 0U);
}

TEST_F(SpaceMouseLinkTest, SaysThatAnotherProgramHasIt) {
  bus_.refuse(TransferStatus::kBusy);
  plug();
  EXPECT_EQ(link_->status().phase, LinkPhase::kRefused);
  EXPECT_NE(link_->advice().find("spacenavd"), std::string::npos);
  bus_.refuse(TransferStatus::kOk);
  run(0.2);
  EXPECT_EQ(link_->status().phase, LinkPhase::kReady);
}

TEST_F(SpaceMouseLinkTest, TurnsAxesRound) {
  settings_ = spacemouse_settings({{"invert", "xb"}});
  plug();
  mouse_->deflect({350, 0, -350, 0, 0, 350});
  run(0.1);
  EXPECT_EQ(axes(), (Axes{-1.0, 1.0, 0.0, 0.0, 1.0, 0.0}));
  EXPECT_THROW((void)spacemouse_settings({{"invert", "q"}}), Error);
  EXPECT_THROW((void)spacemouse_settings({{"speed", "1"}}), Error);
}

TEST_F(SpaceMouseLinkTest, BearsEveryFaultForTwoHours) {
  plug();
  std::mt19937_64 random{2};
  std::uniform_real_distribution<double> unit;
  std::uint64_t rounds = 0;
  const double seconds = soak_seconds(kTwoHours);
  while (bus_.now() < seconds) {
    const bool bad = unit(random) < 0.5;
    bus_.set_faults({.lost_read = bad ? 0.3 * unit(random) : 0.0,
                     .corrupt_read = bad ? 0.3 * unit(random) : 0.0,
                     .stall = bad ? 0.2 * unit(random) : 0.0,
                     .seed = random()});
    if (unit(random) < 0.05) bus_.unplug_at_transfer(1 + random() % 50);
    const auto raw = [&] { return static_cast<std::int16_t>(700.0 * (unit(random) - 0.5)); };
    if (unit(random) < 0.5) {
      mouse_->deflect({raw(), raw(), raw(), raw(), raw(), raw()});
    } else {
      mouse_->deflect({});
    }
    for (const double until = bus_.now() + 2.0 * unit(random); bus_.now() < until; ++rounds) {
      (void)round_with(*link_, Vec3{1.0});
      for (const double v : axes()) ASSERT_LE(std::abs(v), 1.0);
    }
    if (bus_.devices().empty()) bus_.plug("1-4", mouse_);
    ASSERT_LE(bus_.open_connections(), 1);
  }
  EXPECT_GT(static_cast<double>(rounds), 25.0 * seconds);
  bus_.set_faults({});
  mouse_->deflect({});
  run(1.0);
  EXPECT_EQ(link_->status().phase, LinkPhase::kReady);
  EXPECT_EQ(axes(), Axes{});
}

TEST(KnownDevices, AreFoundByTheirIds) {
  ASSERT_NE(find_known({0x0403, 0xcb48}), nullptr);
  EXPECT_EQ(find_known({0x0403, 0xcb48})->driver, "falcon");
  EXPECT_EQ(find_known({0x256f, 0xc650}), nullptr);
  EXPECT_EQ(text_of(UsbId{0x046d, 0xc626}), "046d:c626");
}

}  // namespace
}  // namespace palpate::test
