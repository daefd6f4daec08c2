// Links to Polhemus trackers on USB and at serial lines, against emulated ones in simulated time: what they
// are told, what is made of what they say, and what is left of it when something goes wrong.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/device/driver/polhemus/polhemus_link.h"
#include "common/device/driver/transport/serial_line.h"
#include "common/device/driver/transport/usb_search.h"
#include "tests/common/device/driver/polhemus/polhemus_emulator.h"
#include "tests/common/device/driver/round_with.h"
#include "tests/common/device/driver/soak.h"
#include "tests/common/device/driver/transport/pty_pair.h"

namespace palpate::test {
namespace {

constexpr UsbId kLiberty{0x0f44, 0xff20}, kLegacy{0x0f44, 0xff12}, kPatriot{0x0f44, 0xef12},
    kFastrakId{0x0f44, 0x0002};

/// How far a pose is from where its sensor was when it was measured [m].
double error_of(const PoseAtom& pose, double delay) {
  double least = HUGE_VAL;
  // It was measured some time before it came.
  for (double age = 0.0; age <= delay; age += 1e-3) {
    const double time = pose.time - age;
    least = std::min(least, glm::distance(pose.position, PolhemusEmulator::position(pose.station, time)));
  }
  return least;
}
double turn_error_of(const PoseAtom& pose) {
  return angle_of(pose.orientation * glm::conjugate(PolhemusEmulator::orientation(pose.station, pose.time)));
}

class PolhemusOnUsbTest : public ::testing::Test {
 protected:
  void plug(UsbId id = kLiberty, EmulatedPolhemus settings = {}) {
    settings.fastrak = id.product <= 3;
    if (id == kPatriot) settings.tag = "PA";
    tracker_ = std::make_shared<PolhemusEmulator>(settings);
    usb_ = std::make_shared<PolhemusOnUsb>(id, tracker_);
    bus_.plug("1-3", usb_);
    if (!link_) link_ = std::make_unique<PolhemusLink>(polhemus_on_usb(bus_), settings_);
    run(1.0);
  }
  void run(double seconds) {
    for (const double until = bus_.now() + seconds; bus_.now() < until;) (void)round_with(*link_, Vec3{0.0});
  }
  [[nodiscard]] const PoseAtom& pose(int station) const {
    return link_->poses()->stations[static_cast<std::size_t>(station - 1)];
  }

  FakeUsb bus_;
  PolhemusSettings settings_;
  std::shared_ptr<PolhemusEmulator> tracker_;
  std::shared_ptr<PolhemusOnUsb> usb_;
  std::unique_ptr<PolhemusLink> link_;
};

TEST_F(PolhemusOnUsbTest, FollowsEachStationOfEveryModel) {
  for (const UsbId id : {kLiberty, kLegacy, kPatriot, kFastrakId}) {
    link_.reset();
    plug(id, {.detected = 0b1010});
    ASSERT_EQ(link_->status().phase, LinkPhase::kReady) << text_of(id) << link_->advice();
    EXPECT_EQ(tracker_->bad_commands(), 0) << text_of(id);
    EXPECT_EQ(link_->place(), "usb 1-3");
    for (int n = 0; n < 100; ++n) {
      run(0.01);
      for (const int station : {2, 4}) {
        ASSERT_TRUE(pose(station).valid) << text_of(id);
        EXPECT_EQ(pose(station).station, station);
        ASSERT_LT(error_of(pose(station), 0.01), 1e-3);
        ASSERT_LT(turn_error_of(pose(station)), 0.02);
        ASSERT_NEAR(glm::length(pose(station).orientation), 1.0, 1e-12);
        ASSERT_LT(bus_.now() - pose(station).time, 0.03);
      }
      EXPECT_FALSE(pose(1).valid);
    }
    tracker_->press(4, true);
    run(0.05);
    EXPECT_EQ(pose(4).buttons, 1U);
    EXPECT_EQ(pose(2).buttons, 0U);
    EXPECT_EQ(link_->atoms().buttons, 0b1000U);
    EXPECT_FALSE(link_->atoms().has_position);
    // It is left silent.
    link_.reset();
    EXPECT_FALSE(tracker_->continuous());
    EXPECT_EQ(bus_.open_connections(), 0);
  }
}

TEST_F(PolhemusOnUsbTest, TellsTheHemisphere) {
  settings_ = polhemus_settings({{"hemisphere", "-z"}});
  plug();
  EXPECT_EQ(tracker_->zenith(), Vec3(0.0, 0.0, -1.0));
  run(0.1);
  // Sensors hang below the zenith's plane only if that is the right half: z of the emulated ones is negative.
  EXPECT_LT(error_of(pose(1), 0.01), 1e-3);
  link_.reset();
  settings_ = polhemus_settings({{"hemisphere", "+z"}});
  plug();
  EXPECT_LT(glm::distance(pose(1).position, -PolhemusEmulator::position(1, pose(1).time)), 3e-3)
      << "the opposite place, as a tracker says that is told the wrong half";
}

TEST_F(PolhemusOnUsbTest, SaysWhichStationIsNotSeenWell) {
  plug();
  ASSERT_TRUE(pose(1).valid);
  tracker_->complain(1, 'u');
  tracker_->press(1, true);
  run(0.1);
  EXPECT_FALSE(pose(1).valid);
  EXPECT_EQ(link_->atoms().buttons, 0U);
  EXPECT_TRUE(pose(2).valid);
  EXPECT_NE(link_->advice().find("station 1 reports 'u'"), std::string::npos) << link_->advice();
  tracker_->complain(1, ' ');
  run(0.1);
  EXPECT_TRUE(pose(1).valid);
  EXPECT_EQ(link_->advice(), "");
  tracker_->unplug_sensor(2);
  run(0.2);
  EXPECT_FALSE(pose(2).valid) << "nothing is heard of it any more";
  EXPECT_TRUE(pose(1).valid);
}

TEST_F(PolhemusOnUsbTest, SaysThatThereIsNoSensor) {
  plug(kLiberty, {.detected = 0});
  run(10.0);
  EXPECT_EQ(link_->status().phase, LinkPhase::kRefused);
  EXPECT_NE(link_->advice().find("no sensor"), std::string::npos) << link_->advice();
}

TEST_F(PolhemusOnUsbTest, SetsUpAnewOneThatFellSilent) {
  plug();
  tracker_->hang(true);
  const double hung = bus_.now();
  while (pose(1).valid) (void)round_with(*link_, Vec3{0.0});
  EXPECT_LT(bus_.now() - hung, TrackerStations::kSilence + 0.05);
  run(20.0);
  EXPECT_EQ(link_->status().phase, LinkPhase::kRefused);
  EXPECT_NE(link_->advice().find("does not answer"), std::string::npos) << link_->advice();
  EXPECT_GE(link_->status().faults, 1U);
  tracker_->hang(false);
  run(10.0);
  EXPECT_EQ(link_->status().phase, LinkPhase::kReady);
  EXPECT_TRUE(pose(1).valid);
}

TEST_F(PolhemusOnUsbTest, LosesAllItsStationsOnceItIsUnplugged) {
  plug();
  tracker_->press(1, true);
  run(0.1);
  const double pulled = bus_.now();
  bus_.unplug("1-3");
  bool told = false;
  while (link_->status().phase == LinkPhase::kReady) told = round_with(*link_, Vec3{0.0});
  EXPECT_LT(bus_.now() - pulled, 0.1);
  EXPECT_TRUE(told) << "that they are out of sight is news";
  for (const PoseAtom& each : link_->poses()->stations) EXPECT_FALSE(each.valid || each.buttons != 0);
  EXPECT_EQ(link_->atoms().buttons, 0U);
  EXPECT_EQ(bus_.open_connections(), 0);
  EXPECT_EQ(link_->place(), "");
  bus_.refuse(TransferStatus::kBusy);
  bus_.plug("1-5", usb_);
  run(0.3);
  EXPECT_EQ(link_->status().phase, LinkPhase::kRefused);
  EXPECT_NE(link_->advice().find("another program"), std::string::npos);
  bus_.refuse(TransferStatus::kOk);
  run(1.0);
  EXPECT_EQ(link_->status().phase, LinkPhase::kReady);
  EXPECT_EQ(link_->place(), "usb 1-5");
}

TEST_F(PolhemusOnUsbTest, IsNotReadyWhereItWaitsForItsFirmware) {
  for (const int number : {0x0001, 0xef11, 0xef21, 0xff11, 0xff21}) {
    const auto product = static_cast<std::uint16_t>(number);
    const KnownDevice* const known = find_known({0x0f44, product});
    ASSERT_NE(known, nullptr);
    EXPECT_EQ(known->driver, "");
    EXPECT_NE(known->note.find("firmware"), std::string_view::npos);
  }
  plug({0x0f44, 0xff21});
  EXPECT_EQ(link_->status().phase, LinkPhase::kAbsent);
}

/// Whether every pose that counts is where its sensor was, and no older than it may be. @param delay [s] with
/// which the wire may bring one.
::testing::AssertionResult plausible(const PolhemusLink& link, double now, double delay) {
  for (const PoseAtom& pose : link.poses()->stations) {
    if (!pose.valid) continue;
    constexpr double kSpeed = 0.4;  // [m/s] of the emulated sensors
    constexpr double kDamage = TrackerStations::kLeap + TrackerStations::kMostSpeed * TrackerStations::kGap;
    const double error = glm::distance(pose.position, PolhemusEmulator::position(pose.station, pose.time));
    if (error > kDamage + kSpeed * delay) {
      return ::testing::AssertionFailure() << "station " << int{pose.station} << " is off by " << error;
    }
    if (now - pose.time > TrackerStations::kSilence + 0.05) {
      return ::testing::AssertionFailure() << "station " << int{pose.station} << " is old";
    }
  }
  return ::testing::AssertionSuccess();
}

TEST_F(PolhemusOnUsbTest, BearsEveryFaultForTwoHours) {
  std::mt19937_64 random{4};
  std::uniform_real_distribution<double> unit;
  const double seconds = soak_seconds(0.5 * kTwoHours);  // of each
  std::uint64_t good = 0, unplugged = 0;
  for (const UsbId id : {kLiberty, kFastrakId}) {
    link_.reset();
    bus_.set_faults({});
    plug(id);
    for (const double end = bus_.now() + seconds; bus_.now() < end;) {
      const bool bad = unit(random) < 0.5;
      const auto rate = [&](double most) { return bad ? most * unit(random) : 0.0; };
      bus_.set_faults({.lost_write = rate(0.1),
                       .short_write = rate(0.1),
                       .lost_read = rate(0.2),
                       .corrupt_read = rate(0.03),
                       .short_read = rate(0.2),
                       .late_read = rate(0.1),
                       .stall = rate(0.05),
                       .timeout = rate(0.1),
                       .seed = random()});
      if (unit(random) < 0.1) bus_.unplug_at_transfer(1 + random() % 500);
      tracker_->hang(unit(random) < 0.05);
      tracker_->press(1, unit(random) < 0.5);
      for (const double until = bus_.now() + 4.0 * unit(random); bus_.now() < until;) {
        (void)round_with(*link_, Vec3{1.0});
        if (pose(1).valid) ++good;
        ASSERT_TRUE(plausible(*link_, bus_.now(), 0.15)) << text_of(id);
      }
      if (bus_.devices().empty()) {
        ++unplugged;
        bus_.plug("1-3", usb_);
      }
      ASSERT_LE(bus_.open_connections(), 1);
    }
    bus_.set_faults({});
    tracker_->hang(false);
    run(10.0);
    EXPECT_EQ(link_->status().phase, LinkPhase::kReady) << link_->advice();
    EXPECT_TRUE(pose(1).valid && pose(2).valid);
  }
  EXPECT_GT(static_cast<double>(good), 25.0 * seconds);
  EXPECT_GT(static_cast<double>(unplugged), 0.005 * seconds);
}

class FastrakAtALine : public ::testing::Test {
 protected:
  FastrakAtALine() { begin(); }
  /// A link of its own, at a line of its own.
  void begin() {
    auto line = std::make_unique<FakeLine>();
    line_ = line.get();
    settings_.port = line_->name();
    link_ = std::make_unique<PolhemusLink>(polhemus_on_line(std::move(line), PolhemusFamily::kFastrak),
                                           settings_);
  }
  void run(double seconds) {
    for (const double until = line_->now() + seconds; line_->now() < until;)
      (void)round_with(*link_, Vec3{0.0});
  }
  [[nodiscard]] const PoseAtom& pose(int station) const {
    return link_->poses()->stations[static_cast<std::size_t>(station - 1)];
  }

  PolhemusSettings settings_;
  FakeLine* line_ = nullptr;
  std::shared_ptr<PolhemusEmulator> tracker_ =
      std::make_shared<PolhemusEmulator>(EmulatedPolhemus{.fastrak = true, .rate = 120.0});
  std::unique_ptr<PolhemusLink> link_;
};

TEST_F(FastrakAtALine, IsFoundSetUpAndFollowed) {
  run(0.5);
  EXPECT_EQ(link_->status().phase, LinkPhase::kAbsent);
  EXPECT_NE(link_->advice().find("no serial line /dev/ttyFAKE"), std::string::npos) << link_->advice();
  line_->refuse(TransferStatus::kDenied);
  run(0.5);
  EXPECT_EQ(link_->status().phase, LinkPhase::kRefused);
  EXPECT_NE(link_->advice().find("dialout"), std::string::npos) << link_->advice();
  line_->refuse(TransferStatus::kOk);
  line_->plug(tracker_);
  run(1.0);
  ASSERT_EQ(link_->status().phase, LinkPhase::kReady) << link_->advice();
  EXPECT_EQ(tracker_->order(), "2,11,16,0");
  EXPECT_EQ(tracker_->bad_commands(), 0);
  EXPECT_EQ(link_->place(), "/dev/ttyFAKE");
  for (int n = 0; n < 100; ++n) {
    run(0.01);
    for (const int station : {1, 2}) {
      ASSERT_TRUE(pose(station).valid);
      ASSERT_LT(error_of(pose(station), 0.02), 1e-3);
    }
  }
  const double pulled = line_->now();
  line_->unplug();
  while (link_->status().phase == LinkPhase::kReady) (void)round_with(*link_, Vec3{0.0});
  EXPECT_LT(line_->now() - pulled, 0.1);
  EXPECT_FALSE(pose(1).valid);
  EXPECT_EQ(line_->open_streams(), 0);
}

// Four stations of 34 bytes at 19200 baud: each comes 14 times a second, and two are seen.
TEST_F(FastrakAtALine, IsFollowedAtASlowLine) {
  settings_.baud = 19200;
  tracker_ = std::make_shared<PolhemusEmulator>(EmulatedPolhemus{.fastrak = true, .rate = 28.0});
  begin();
  line_->plug(tracker_);
  run(2.0);
  ASSERT_EQ(link_->status().phase, LinkPhase::kReady) << link_->advice();
  EXPECT_EQ(link_->advice(), "");
  for (int n = 0; n < 200; ++n) {
    run(0.01);
    ASSERT_TRUE(pose(1).valid && pose(2).valid) << n;
  }
  // What no hand can be led by is said.
  settings_.baud = 9600;
  begin();
  line_->plug(tracker_);
  run(2.0);
  EXPECT_NE(link_->advice().find("too slow"), std::string::npos) << link_->advice();
}

TEST_F(FastrakAtALine, SaysWhatToLookAtWhereNothingMakesSense) {
  line_->plug(tracker_);
  tracker_->deafen(true);
  run(10.0);
  EXPECT_EQ(link_->status().phase, LinkPhase::kRefused);
  EXPECT_NE(link_->advice().find("baud="), std::string::npos) << link_->advice();
}

TEST_F(FastrakAtALine, BearsEveryFaultForTwoHours) {
  line_->plug(tracker_);
  std::mt19937_64 random{6};
  std::uniform_real_distribution<double> unit;
  const double seconds = soak_seconds(kTwoHours);
  std::uint64_t good = 0;
  while (line_->now() < seconds) {
    const bool bad = unit(random) < 0.5;
    const auto rate = [&](double most) { return bad ? most * unit(random) : 0.0; };
    line_->set_faults({.lost_byte = rate(0.003),
                       .corrupt_byte = rate(0.003),
                       .foreign_byte = rate(0.003),
                       .split_read = rate(0.5),
                       .late_read = rate(0.05),
                       .lost_write = rate(0.1),
                       .short_write = rate(0.1),
                       .seed = random()});
    if (unit(random) < 0.1) line_->unplug_at_call(1 + random() % 500);
    tracker_->hang(unit(random) < 0.05);
    for (const double until = line_->now() + 4.0 * unit(random); line_->now() < until;) {
      (void)round_with(*link_, Vec3{1.0});
      if (pose(1).valid) ++good;
      ASSERT_TRUE(plausible(*link_, line_->now(), 0.2));
    }
    if (!line_->plugged()) line_->plug(tracker_);
    ASSERT_LE(line_->open_streams(), 1);
  }
  EXPECT_GT(static_cast<double>(good), 25.0 * seconds);
  line_->set_faults({});
  tracker_->hang(false);
  run(10.0);
  EXPECT_EQ(link_->status().phase, LinkPhase::kReady) << link_->advice();
  EXPECT_TRUE(pose(1).valid && pose(2).valid);
}

// Through a real pair of pseudo terminals, in real time.
TEST(PolhemusAtAPty, IsFollowedAndItsEndIsNoted) {
  for (const bool fastrak : {true, false}) {
    const auto tracker = std::make_shared<PolhemusEmulator>(EmulatedPolhemus{.fastrak = fastrak});
    auto pair = std::make_unique<PtyPair>(tracker);
    PolhemusSettings settings{.port = pair->path()};
    const auto family = fastrak ? PolhemusFamily::kFastrak : PolhemusFamily::kLiberty;
    PolhemusLink link(polhemus_on_line(std::make_unique<SerialLine>(settings.port, 115200), family),
                      settings);
    constexpr int kMostRounds = 20'000;
    int n = 0;
    const auto seen = [&] { return link.poses()->stations[0].valid && link.poses()->stations[1].valid; };
    for (; n < kMostRounds && !seen(); ++n) (void)round_with(link, Vec3{0.0});
    ASSERT_TRUE(seen()) << link.advice();
    constexpr double kLoaded = 0.5;  // [s] that a loaded machine may take to hand bytes on
    EXPECT_LT(error_of(link.poses()->stations[0], kLoaded), 2e-3);
    pair.reset();
    for (n = 0; n < kMostRounds && link.status().phase != LinkPhase::kAbsent; ++n)
      (void)round_with(link, Vec3{0.0});
    EXPECT_FALSE(seen());
  }
}

TEST(PolhemusOptions, AreReadAndRefused) {
  const PolhemusSettings settings = polhemus_settings(
      {{"port", "/dev/ttyUSB0"}, {"baud", "19200"}, {"model", "patriot"}, {"hemisphere", "-y"}});
  EXPECT_EQ(settings.port, "/dev/ttyUSB0");
  EXPECT_EQ(settings.baud, 19200);
  EXPECT_EQ(settings.family, PolhemusFamily::kLiberty);
  EXPECT_EQ(settings.hemisphere, Vec3(0.0, -1.0, 0.0));
  EXPECT_EQ(polhemus_settings({}).port, "");
  const std::vector<DriverOptions> wrong{{{"speed", "1"}},
                                         {{"port", "/dev/ttyUSB0"}, {"baud", "14400"}},
                                         {{"port", "/dev/ttyUSB0"}, {"model", "viper"}},
                                         {{"hemisphere", "x"}},
                                         {{"hemisphere", "+w"}},
                                         {{"baud", "9600"}},
                                         {{"model", "fastrak"}}};
  for (const DriverOptions& each : wrong) EXPECT_THROW((void)polhemus_settings(each), Error) << each[0].first;
}

}  // namespace
}  // namespace palpate::test
