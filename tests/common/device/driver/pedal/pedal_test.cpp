// Foot switches, reports and link, against emulated ones in simulated time, and as the dead-man switch of
// another device.

#include <array>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/device/driver/pedal/pedal_link.h"
#include "common/device/driver/transport/usb_search.h"
#include "common/servo/linked_device.h"
#include "common/servo/safety_stage.h"
#include "tests/common/device/driver/pedal/pedal_emulator.h"
#include "tests/common/device/driver/round_with.h"
#include "tests/common/device/driver/soak.h"
#include "tests/common/device/driver/transport/fake_usb.h"
#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr UsbId kXk3{0x05f3, 0x042c}, kVec{0x05f3, 0x00ff}, kPcSensor{0x0c45, 0x7403};

TEST(PedalReport, ReadsEachFormat) {
  EXPECT_EQ(pedals_of(PedalFormat::kXKeys, Bytes{0, 1, 0x00}), 0U);
  EXPECT_EQ(pedals_of(PedalFormat::kXKeys, Bytes{0, 1, 0x02, 9, 9}), 1U);
  EXPECT_EQ(pedals_of(PedalFormat::kXKeys, Bytes{0, 1, 0x0C}), 6U);
  EXPECT_EQ(pedals_of(PedalFormat::kInfinity, Bytes{0x05, 0}), 5U);
  EXPECT_EQ(pedals_of(PedalFormat::kKeyboard, Bytes{0, 0, 0, 0, 0, 0, 0, 0}), 0U);
  EXPECT_EQ(pedals_of(PedalFormat::kKeyboard, Bytes{0, 0, 0x06, 0, 0x04, 0, 0, 0}), 5U);
  EXPECT_EQ(pedals_of(PedalFormat::kKeyboard, Bytes{0, 0, 0x2C, 0, 0, 0, 0, 0}), 1U) << "set up as a space";
  EXPECT_EQ(pedals_of(PedalFormat::kKeyboard, Bytes{2, 0, 0, 0, 0, 0, 0, 0}), 1U) << "set up as a shift";
}

TEST(PedalReport, RefusesWhatIsNone) {
  for (const Bytes& report :
       {Bytes{}, Bytes{0, 1}, Bytes{1, 1, 2}, Bytes{0, 0, 2}, Bytes{0, 1, 3}, Bytes{0, 1, 0x12}}) {
    EXPECT_FALSE(pedals_of(PedalFormat::kXKeys, report).has_value());
  }
  for (const Bytes& report : {Bytes{}, Bytes{1}, Bytes{1, 0, 0}, Bytes{8, 0}, Bytes{1, 1}}) {
    EXPECT_FALSE(pedals_of(PedalFormat::kInfinity, report).has_value());
  }
  for (const Bytes& report : {Bytes{}, Bytes{0, 0, 4}, Bytes{0, 1, 4, 0, 0, 0, 0, 0},
                              Bytes{0, 0, 1, 1, 1, 1, 1, 1}, Bytes{0, 0, 4, 0, 0, 0, 0, 0, 0}}) {
    EXPECT_FALSE(pedals_of(PedalFormat::kKeyboard, report).has_value());
  }
}

TEST(PedalReport, SurvivesAnyBytes) {
  std::mt19937 random{7};
  std::array<std::uint8_t, 64> report{};
  const AllocationGuard guard;
  for (int n = 0; n < 300'000; ++n) {
    for (std::uint8_t& byte : report) byte = static_cast<std::uint8_t>(random() % 16);
    const auto pedals = pedals_of(static_cast<PedalFormat>(n % 3), std::span(report).first(random() % 12));
    ASSERT_LE(pedals.value_or(0), 7U);
  }
  EXPECT_EQ(guard.count(), 0U);
}

class PedalLinkTest : public ::testing::Test {
 protected:
  void plug(const EmulatedPedal& settings = {}) {
    pedal_ = std::make_shared<PedalEmulator>(settings);
    bus_.plug("1-4", pedal_);
    link_ = std::make_unique<PedalLink>(bus_);
    run(0.05);
  }
  /// As LinkedDevice works it: what is not new is not heard of.
  void round() {
    if (round_with(*link_, Vec3{0.0})) heard_ = link_->atoms();
  }
  void run(double seconds) {
    for (const double until = bus_.now() + seconds; bus_.now() < until;) round();
  }
  [[nodiscard]] bool held(int button = 0) const { return with_switch(0, &heard_, button, bus_.now()) != 0; }
  /// [s] until the switch counts as released.
  double time_to_release(int button = 0) {
    const double lost = bus_.now();
    while (held(button) && bus_.now() < lost + 1.0) round();
    return bus_.now() - lost;
  }

  FakeUsb bus_;
  std::shared_ptr<PedalEmulator> pedal_;
  std::unique_ptr<PedalLink> link_;
  DeviceAtoms heard_;
};

constexpr double kAllowed = 0.100;  // [s] from losing the switch to no force

TEST_F(PedalLinkTest, IsHeardInEveryFormatWhetherItRepeatsItselfOrIsAsked) {
  for (const UsbId id : {kXk3, kVec, kPcSensor}) {
    for (const bool repeats : {true, false}) {
      heard_ = {};
      plug({.id = id, .repeats = repeats, .answers = !repeats});
      ASSERT_EQ(link_->status().phase, LinkPhase::kReady) << text_of(id) << repeats;
      EXPECT_EQ(pedal_->idle(), repeats ? PedalLink::kRepeat : 0.0);
      for (int button = 0; button < 3; ++button) {
        pedal_->press(1U << button);
        run(0.05);
        for (int n = 0; n < 300; ++n) {  // held for long, and never said to be released
          round();
          ASSERT_TRUE(held(button)) << text_of(id) << repeats << n;
        }
        EXPECT_FALSE(held((button + 1) % 3));
      }
      pedal_->press(0);
      EXPECT_LT(time_to_release(2), 0.030);
      bus_.unplug("1-4");
    }
  }
}

TEST_F(PedalLinkTest, CountsAsReleasedUntilItWasReleasedOnce) {
  pedal_ = std::make_shared<PedalEmulator>();
  pedal_->press(1);
  bus_.plug("1-4", pedal_);
  link_ = std::make_unique<PedalLink>(bus_);
  run(1.0);
  EXPECT_FALSE(held()) << "something may lie on it";
  pedal_->press(0);
  run(0.05);
  pedal_->press(1);
  run(0.05);
  EXPECT_TRUE(held());
}

TEST_F(PedalLinkTest, IsReleasedByEveryFault) {
  using Fault = void (*)(FakeUsb&, PedalEmulator&);
  const std::array<std::pair<const char*, Fault>, 7> faults{{
      {"unplugged", [](FakeUsb& bus, PedalEmulator&) { bus.unplug("1-4"); }},
      {"hung", [](FakeUsb&, PedalEmulator& pedal) { pedal.hang(true); }},
      {"silent", [](FakeUsb& bus, PedalEmulator&) { bus.set_faults({.lost_read = 1.0}); }},
      {"stalled", [](FakeUsb& bus, PedalEmulator&) { bus.set_faults({.stall = 1.0}); }},
      {"split", [](FakeUsb& bus, PedalEmulator&) { bus.set_faults({.short_read = 1.0}); }},
      {"late", [](FakeUsb& bus, PedalEmulator&) { bus.set_faults({.late_read = 1.0, .lateness = 0.2}); }},
      {"strange",
       [](FakeUsb&, PedalEmulator& pedal) {
         pedal.hang(true), pedal.say({1, 1, 1, 1});
       }},
  }};
  for (const auto& [name, fault] : faults) {
    bus_.set_faults({});
    heard_ = {};
    plug();
    pedal_->press(1);
    run(0.2);
    ASSERT_TRUE(held()) << name;
    fault(bus_, *pedal_);
    // The servo goes on while the link waits for its bus: what it heard last grows old.
    const double lost = bus_.now(), last = heard_.time;
    while (bus_.now() < lost + 0.3) round();
    EXPECT_TRUE(heard_.buttons == 0 || heard_.time == last || std::string_view(name) == "late") << name;
    EXPECT_LE(kEnablingStale + DeviceLimits{}.fade_time, kAllowed);
    if (std::string_view(name) == "late") continue;
    EXPECT_FALSE(held()) << name;
  }
}

// The whole way: pedal, its bus, the rule of its age, the fade.
TEST_F(PedalLinkTest, TakesTheForceAwayWithinTheTimeAllowed) {
  for (const char* fault : {"release", "hang", "unplug"}) {
    heard_ = {};
    plug();
    SafetyStage stage({.enabling_button = EnablingSwitch::kOtherBit});
    Vec3 force{0.0};
    double last = bus_.now();
    const auto step = [&] {
      round();
      const std::uint32_t buttons = with_switch(0, &heard_, 0, bus_.now());
      force = stage.apply({.force = {1.0, 0.0, 0.0}, .dt = bus_.now() - last, .buttons = buttons});
      last = bus_.now();
    };
    for (int n = 0; n < 50; ++n) step();
    EXPECT_EQ(force, Vec3(0.0));
    pedal_->press(1);
    for (int n = 0; n < 300; ++n) step();
    ASSERT_EQ(force.x, 1.0);
    const double lost = bus_.now();
    const std::string_view what = fault;
    if (what == "release") pedal_->press(0);
    if (what == "hang") pedal_->hang(true);
    if (what == "unplug") bus_.unplug("1-4");
    while (force != Vec3(0.0) && bus_.now() < lost + 1.0) step();
    RecordProperty(std::string(fault) + "_ms", std::to_string(1e3 * (bus_.now() - lost)));
    // The servo's step is a round of the pedal's here, 22 ms at most where nothing comes; alone it is 1 ms.
    EXPECT_LT(bus_.now() - lost, kAllowed + 0.022) << fault;
    bus_.unplug("1-4");
  }
}

TEST_F(PedalLinkTest, SaysWhenItCannotGuardAHand) {
  plug({.repeats = false, .answers = false});
  run(1.0);
  EXPECT_EQ(link_->status().phase, LinkPhase::kRefused);
  EXPECT_NE(link_->advice().find("cannot guard a hand"), std::string::npos);
  pedal_->press(1);
  run(0.2);
  EXPECT_FALSE(held()) << "it spoke once, when it was pressed";
}

TEST_F(PedalLinkTest, IsFoundAgainAndSaysWhoHasIt) {
  plug();
  bus_.unplug("1-4");
  const double pulled = bus_.now();
  while (link_->status().phase == LinkPhase::kReady) round();
  EXPECT_LT(bus_.now() - pulled, 0.1);
  EXPECT_EQ(bus_.open_connections(), 0);
  EXPECT_EQ(link_->place(), "");
  bus_.refuse(TransferStatus::kBusy);
  bus_.plug("1-5", pedal_);
  run(0.3);
  EXPECT_EQ(link_->status().phase, LinkPhase::kRefused);
  EXPECT_NE(link_->advice().find("another program"), std::string::npos);
  bus_.refuse(TransferStatus::kOk);
  run(0.3);
  EXPECT_EQ(link_->status().phase, LinkPhase::kReady);
  EXPECT_EQ(link_->place(), "usb 1-5");
}

TEST_F(PedalLinkTest, BearsEveryFaultForTwoHours) {
  plug();
  std::mt19937_64 random{3};
  std::uniform_real_distribution<double> unit;
  double released_at = 0.0;  // when nothing was pressed any more
  bool down = false;
  std::uint64_t rounds = 0, helds = 0;
  const double seconds = soak_seconds(kTwoHours);
  while (bus_.now() < seconds) {
    const bool bad = unit(random) < 0.5;
    bus_.set_faults({.lost_read = bad ? 0.3 * unit(random) : 0.0,
                     .short_read = bad ? 0.3 * unit(random) : 0.0,
                     .late_read = bad ? 0.1 * unit(random) : 0.0,
                     .stall = bad ? 0.2 * unit(random) : 0.0,
                     .seed = random()});
    if (unit(random) < 0.05) bus_.unplug_at_transfer(1 + random() % 50);
    if (unit(random) < 0.1) pedal_->say({static_cast<std::uint8_t>(random()), 1, 7});
    const bool press = unit(random) < 0.5;
    if (down && !press) released_at = bus_.now();
    down = press;
    pedal_->press(down ? 1 : 0);
    for (const double until = bus_.now() + 2.0 * unit(random); bus_.now() < until; ++rounds) {
      round();
      if (held()) ++helds;
      // A report that the bus lost is made good by the next.
      const bool long_ago = !down && bus_.now() > released_at + kAllowed + kEnablingStale;
      ASSERT_FALSE(long_ago && held());
    }
    if (bus_.devices().empty()) bus_.plug("1-4", pedal_);
    ASSERT_LE(bus_.open_connections(), 1);
  }
  EXPECT_GT(static_cast<double>(rounds), 25.0 * seconds);
  EXPECT_GT(static_cast<double>(helds), 2.5 * seconds);
}

}  // namespace
}  // namespace palpate::test
