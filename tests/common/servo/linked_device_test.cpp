// A link on its thread, and a device laid over the workspace: who is told what, and what is left when either
// side falls silent.

#include "common/servo/linked_device.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/haptics/constraint/half_space.h"
#include "common/haptics/proxy_chain.h"
#include "common/servo/live_hands.h"
#include "common/servo/placed_device.h"
#include "common/servo/real_time.h"
#include "common/servo/servo_loop.h"

namespace palpate::test {
namespace {

/// Says what the test wants and remembers what it was told.
class ScriptedLink final : public DriverLink {
 public:
  bool round() noexcept override {
    const Vec3 force = ordered();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const std::lock_guard lock(mutex_);
    reported_ = force;
    ++rounds_;
    atoms_ = said_;
    poses_ = said_poses_;
    return speaks_;
  }
  [[nodiscard]] const DeviceAtoms& atoms() const noexcept override { return atoms_; }
  [[nodiscard]] const LinkStatus& status() const noexcept override { return status_; }
  [[nodiscard]] std::string advice() const override { return "move it"; }
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }
  [[nodiscard]] std::string place() const override { return "here"; }
  [[nodiscard]] const PoseAtoms* poses() const noexcept override { return tracks_ ? &poses_ : nullptr; }

  void say(const DeviceAtoms& atoms) {
    const std::lock_guard lock(mutex_);
    said_ = atoms;
    speaks_ = true;
  }
  void show(const PoseAtom& pose) {
    const std::lock_guard lock(mutex_);
    said_poses_.stations[pose.station - 1U] = pose;
    speaks_ = true;
  }
  [[nodiscard]] Vec3 told() const {
    const std::lock_guard lock(mutex_);
    return reported_;
  }
  [[nodiscard]] std::uint64_t rounds() const {
    const std::lock_guard lock(mutex_);
    return rounds_;
  }
  DeviceLimits limits_;
  bool tracks_ = false;

 private:
  mutable std::mutex mutex_;
  Vec3 reported_{0.0};
  std::uint64_t rounds_ = 0;
  bool speaks_ = false;
  DeviceAtoms said_, atoms_;
  PoseAtoms said_poses_, poses_;
  LinkStatus status_;
};

double now() { return 1e-9 * static_cast<double>(monotonic_ns()); }

/// Whether `what` comes true at all; how long it takes is no matter.
bool comes(const std::function<bool()>& what) {
  constexpr double kLimit = 20.0;  // [s]
  for (const double until = now() + kLimit; now() < until;) {
    if (what()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

class LinkedDeviceTest : public ::testing::Test {
 protected:
  void say(const Vec3& position) {
    link_->say({.time = now(), .buttons = 3, .has_position = true, .position = position});
  }

  std::shared_ptr<ScriptedLink> link_ = std::make_shared<ScriptedLink>();
};

TEST_F(LinkedDeviceTest, GivesTheNewestSampleAndKeepsItForAWhile) {
  LinkedDevice device(link_);
  DeviceSample sample;
  EXPECT_FALSE(device.read(now(), sample));
  say({0.1, 0.2, 0.3});
  ASSERT_TRUE(comes([&] { return device.read(now(), sample); }));
  EXPECT_EQ(sample.position, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(sample.buttons, 3U);
  // Its age is what the safety stage sees; then there is no hand any more.
  const double time = sample.time;
  EXPECT_TRUE(device.read(time + 0.9 * LinkedDevice::kKept, sample));
  EXPECT_EQ(sample.time, time);
  EXPECT_FALSE(device.read(time + 1.1 * LinkedDevice::kKept, sample));
  EXPECT_TRUE(comes([&] { return device.advice() == "move it"; }));
}

// Before anybody has looked for it a device is not missing.
TEST_F(LinkedDeviceTest, GivesADeviceItsChanceBeforeItIsSaidToBeMissing) {
  const double start = now();
  const LinkedDevice device(link_);
  EXPECT_EQ(device.advice(), "");
  ASSERT_TRUE(comes([&] { return device.advice() == "move it"; }));
  EXPECT_GE(now() - start, LinkedDevice::kChance);
}

TEST_F(LinkedDeviceTest, GivesTheNewestPosesEachForAWhile) {
  EXPECT_FALSE(LinkedDevice(link_).tracks());
  link_->tracks_ = true;
  LinkedDevice device(link_);
  EXPECT_TRUE(device.tracks());
  PoseAtoms poses;
  device.read_poses(now(), poses);
  EXPECT_FALSE(poses.stations[2].valid);
  const double late = now() - 0.9 * LinkedDevice::kPosesKept, time = late + 0.5 * LinkedDevice::kPosesKept;
  const PoseAtom third{.time = time,
                       .position = {1.0, 2.0, 3.0},
                       .orientation = {0.6, 0.0, 0.8, 0.0},
                       .buttons = 1,
                       .station = 3,
                       .valid = true};
  link_->show({.time = late, .buttons = 2, .station = 1, .valid = true});
  link_->show(third);
  ASSERT_TRUE(comes([&] {
    device.read_poses(time, poses);
    return poses.stations[2].valid;
  }));
  EXPECT_EQ(poses.stations[2], third);
  EXPECT_TRUE(poses.stations[0].valid);
  // One station has fallen silent, the other has not: what it was is still known, its button is up.
  device.read_poses(late + 1.05 * LinkedDevice::kPosesKept, poses);
  EXPECT_FALSE(poses.stations[0].valid);
  EXPECT_EQ(poses.stations[0].buttons, 0U);
  EXPECT_EQ(poses.stations[2], third);
}

TEST_F(LinkedDeviceTest, PassesForcesOnWhileTheyAreRenewed) {
  LinkedDevice device(link_);
  const Vec3 force{1.0, 2.0, 3.0};
  EXPECT_TRUE(comes([&] {
    device.command(force);
    return link_->told() == force;
  }));
  // A servo that has stalled renews nothing.
  EXPECT_TRUE(comes([&] { return link_->told() == Vec3{0.0}; }));
}

TEST_F(LinkedDeviceTest, StopsAtOnceAndUntilTheNextCommand) {
  LinkedDevice device(link_);
  const Vec3 force{1.0, 0.0, 0.0};
  ASSERT_TRUE(comes([&] {
    device.command(force);
    return link_->told() == force;
  }));
  device.command(force);
  device.emergency_stop();
  const std::uint64_t before = link_->rounds();
  ASSERT_TRUE(comes([&] { return link_->rounds() >= before + 2; }));
  EXPECT_EQ(link_->told(), Vec3{0.0});
  EXPECT_TRUE(comes([&] {
    device.command(force);
    return link_->told() == force;
  }));
}

/// Tells the force of a round first, then reads the next position, as arms do; each position has its round's number.
class CountingLink final : public DriverLink {
 public:
  static constexpr double kStep =
      1e-5;  // [m] by which the wall is pressed further each round, back after kRounds
  static constexpr int kRounds = 1000;

  CountingLink() {
    limits_.reach_lower = Vec3{-1.0};
    limits_.reach_upper = Vec3{1.0};
    limits_.force_cap = limits_.slew_cap = limits_.velocity_gate = 1e6;
  }
  bool round() noexcept override {
    std::this_thread::sleep_until(next_ += std::chrono::milliseconds(1));
    const double depth = -ordered().z / kStiffness;
    const int shown = static_cast<int>(std::lround(depth / kStep));
    const int lag = (round_ - shown + kRounds) % kRounds + 1;
    // Not where the depth falls back, and not where no force was shown yet.
    if (shown > 0 && round_ > 100) ++lags_[static_cast<std::size_t>(std::min(lag, 3))];
    round_ = (round_ + 1) % kRounds;
    atoms_ = {.time = now(), .has_position = true, .position = {0.0, 0.0, kStep * round_}};
    ++rounds_;
    return true;
  }
  [[nodiscard]] const DeviceAtoms& atoms() const noexcept override { return atoms_; }
  [[nodiscard]] const LinkStatus& status() const noexcept override { return status_; }
  [[nodiscard]] std::string advice() const override { return {}; }
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }
  [[nodiscard]] std::string place() const override { return "here"; }

  static constexpr double kStiffness = 100.0;  // [N/m]
  std::array<std::atomic<int>, 4> lags_{};  ///< rounds by how many rounds old the sample of their force was
  std::atomic<int> rounds_{0};

 private:
  int round_ = 0;
  std::chrono::steady_clock::time_point next_ = std::chrono::steady_clock::now();
  DeviceAtoms atoms_;
  LinkStatus status_{.phase = LinkPhase::kReady};
  DeviceLimits limits_;
};

// Counted in rounds, not in time: it was two before the link asked for the force as late as it can, and before the
// servo followed the samples.
TEST_F(LinkedDeviceTest, AForceIsShownInTheRoundAfterItsSample) {
  const auto link = std::make_shared<CountingLink>();
  LinkedDevice device(link);
  ChainSettings settings;
  settings.stiffness = CountingLink::kStiffness;
  settings.damping = 0.0;
  std::vector<std::unique_ptr<Constraint>> wall;
  wall.push_back(std::make_unique<HalfSpaceConstraint>(Vec3{0.0}, Vec3{0.0, 0.0, -1.0}));
  ServoLoop servo(device, std::make_unique<ProxyChain>(std::move(wall), settings), "");
  ASSERT_TRUE(comes([&] { return link->rounds_ > 3000; }));
  const int all = link->lags_[0] + link->lags_[1] + link->lags_[2] + link->lags_[3];
  EXPECT_GT(link->lags_[1], all / 2) << link->lags_[0] << " " << link->lags_[1] << " " << link->lags_[2]
                                     << " " << link->lags_[3];
}

TEST_F(LinkedDeviceTest, LeavesNoForceBehind) {
  {
    LinkedDevice device(link_);
    ASSERT_TRUE(comes([&] {
      device.command({0.0, 5.0, 0.0});
      return link_->told() == Vec3(0.0, 5.0, 0.0);
    }));
  }
  EXPECT_EQ(link_->told(), Vec3{0.0});
}

// A dead-man switch on another device, worked by a thread of its own: a button of the samples, as long as
// that device is heard.
TEST_F(LinkedDeviceTest, CarriesTheSwitchOfAnotherDeviceInItsSamples) {
  const auto pedal = std::make_shared<ScriptedLink>();
  LinkedDevice device(link_, {.button = 1, .link = pedal});
  ASSERT_EQ(device.limits().enabling_button, EnablingSwitch::kOtherBit);
  constexpr std::uint32_t kBit = 1U << static_cast<unsigned>(EnablingSwitch::kOtherBit);
  const auto buttons = [&](std::uint32_t of_pedal, double age) {
    pedal->say({.time = now() - age, .buttons = of_pedal});
    say({0.1, 0.2, 0.3});
    DeviceSample sample;
    return device.read(now(), sample) ? sample.buttons : 0U;
  };
  EXPECT_TRUE(comes([&] { return buttons(0b10, 0.0) == (3U | kBit); }));
  EXPECT_TRUE(comes([&] { return buttons(0b01, 0.0) == 3U; })) << "another button of it";
  EXPECT_TRUE(comes([&] { return buttons(0b10, 0.0) == (3U | kBit); }));
  EXPECT_TRUE(comes([&] { return buttons(0b10, 0.1) == 3U; })) << "down, when it was heard last";
  // The device goes on, its switch has fallen silent.
  EXPECT_TRUE(comes([&] { return buttons(0b10, 0.0) == (3U | kBit); }));
  EXPECT_TRUE(comes([&] {
    say({0.1, 0.2, 0.3});
    DeviceSample sample;
    return device.read(now(), sample) && sample.buttons == 3U;
  }));
}

// Hands by the stations of a tracker; who is out of sight holds nothing.
TEST_F(LinkedDeviceTest, GivesHandsByTheirStations) {
  link_->tracks_ = true;
  const auto device = std::make_shared<LinkedDevice>(link_);
  LiveHands live(device, {.stylus = 2, .other = 5});
  TrackedHands hands;
  EXPECT_FALSE(live.read(0.0, hands)) << "none is in sight";
  const auto show = [&](std::uint8_t station, double x, std::uint32_t buttons) {
    link_->show(
        {.time = now(), .position = {x, 0, 0}, .buttons = buttons, .station = station, .valid = true});
  };
  ASSERT_TRUE(comes([&] {
    show(2, 1.0, 0b11);
    return live.read(0.0, hands) && hands.stylus;
  }));
  EXPECT_EQ(hands.stylus->position.x, 1.0);
  EXPECT_TRUE(hands.acts && hands.clutch);
  EXPECT_TRUE(!hands.other && !hands.carries);
  ASSERT_TRUE(comes([&] {
    show(5, 2.0, 0b01);
    return live.read(0.0, hands) && hands.other && !hands.stylus;
  })) << "the stylus has fallen silent";
  EXPECT_TRUE(!hands.acts && !hands.clutch && hands.carries);
}

class PlacedDeviceTest : public LinkedDeviceTest {
 protected:
  PlacedDeviceTest() {
    link_->limits_.reach_lower = Vec3{-0.05};
    link_->limits_.reach_upper = Vec3{0.05};
  }
  /// Right, up and towards the user are x, z and -y, as in a view along y.
  const Placement placement_{.middle = {1.0, 2.0, 3.0},
                             .axes = Mat3{Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{0, -1, 0}}};
};

TEST_F(PlacedDeviceTest, LaysPositionsAndForcesOverTheView) {
  LinkedDevice linked(link_);
  PlacedDevice device(linked, {}, placement_, {});
  DeviceSample sample;
  say({0.01, 0.02, 0.03});
  ASSERT_TRUE(comes([&] { return device.read(now(), sample); }));
  EXPECT_LT(glm::distance(sample.position, Vec3(1.01, 1.97, 3.02)), 1e-15);
  EXPECT_TRUE(comes([&] {
    device.command({0.0, -2.0, 1.0});
    return glm::distance(link_->told(), Vec3(0.0, 1.0, 2.0)) < 1e-15;
  }));
}

// A wall of the workspace is never stiffer in the hand than it is there, nor pushes harder.
TEST_F(PlacedDeviceTest, EnlargesMotionsWithoutStiffeningTheHand) {
  for (const double scale : {4.0, 0.25}) {
    LinkedDevice linked(link_);
    Placement placement = placement_;
    placement.scale = scale;
    PlacedDevice device(linked, {}, placement, {});
    DeviceSample sample;
    say({0.01, 0.02, 0.03});
    ASSERT_TRUE(comes([&] { return device.read(now(), sample); }));
    EXPECT_LT(glm::distance(sample.position, Vec3(1.0, 2.0, 3.0) + scale * Vec3(0.01, -0.03, 0.02)), 1e-14);
    const double part = scale > 1.0 ? 1.0 / scale : 1.0;
    EXPECT_TRUE(comes([&] {
      device.command({0.0, -2.0, 1.0});
      return glm::distance(link_->told(), part * Vec3(0.0, 1.0, 2.0)) < 1e-15;
    }));
  }
}

// The hand is anywhere, the probe on the plane; a pull across it does no work there, and none is shown.
TEST_F(PlacedDeviceTest, MovesOnAPlaneAloneAndIsPulledWithinIt) {
  LinkedDevice linked(link_);
  Placement placement = placement_;
  placement.surface = Vec4{0.0, 0.6, 0.8, 0.01};
  PlacedDevice device(linked, {}, placement, {});
  DeviceSample sample;
  say({0.01, 0.02, 0.03});
  ASSERT_TRUE(comes([&] { return device.read(now(), sample); }));
  const Vec3 n{0.0, 0.6, 0.8}, in_hand = (sample.position - placement.middle) * placement.axes;
  EXPECT_NEAR(glm::dot(n, in_hand), 0.01, 1e-15);
  EXPECT_LT(glm::length(glm::cross(n, in_hand - Vec3(0.01, 0.02, 0.03))), 1e-15) << "the nearest place";
  // Of 1 N along each axis of the hand.
  const Vec3 expected = Vec3{1.0} - glm::dot(n, Vec3{1.0}) * n;
  EXPECT_TRUE(comes([&] {
    device.command(placement.axes * Vec3{1.0});
    return glm::distance(link_->told(), expected) < 1e-15;
  }));
}

// While the hand works a menu its button is that of the menu alone.
TEST_F(PlacedDeviceTest, HidesTheFirstButtonWhileTheHandWorksSomethingElse) {
  LinkedDevice linked(link_);
  PlacedDevice device(linked, {}, placement_, {});
  DeviceSample sample;
  const auto pressed = [&](bool elsewhere) {
    device.engage(elsewhere);
    return comes([&] {
      link_->say({.time = now(), .buttons = 3U, .has_position = true});
      return device.read(now(), sample) && device.buttons() == 3U;
    });
  };
  ASSERT_TRUE(pressed(false));
  EXPECT_EQ(sample.buttons, 3U);
  ASSERT_TRUE(pressed(true));
  EXPECT_EQ(sample.buttons, 2U);
  DeviceLimits limits;
  limits.enabling_button = 0;
  PlacedDevice enabled(linked, limits, placement_, {});
  enabled.engage(true);
  ASSERT_TRUE(comes([&] {
    link_->say({.time = now(), .buttons = 3U, .has_position = true});
    return enabled.read(now(), sample);
  }));
  EXPECT_EQ(sample.buttons, 3U) << "a dead-man switch is never hidden";
}

TEST_F(PlacedDeviceTest, LetsGoOfTheHandWhereTheViewTurns) {
  LinkedDevice linked(link_);
  PlacedDevice device(linked, {}, placement_, {});
  DeviceSample sample;
  say({0.0, 0.0, 0.0});
  ASSERT_TRUE(comes([&] { return device.read(now(), sample); }));
  device.place({.middle = {7.0, 8.0, 9.0}});
  EXPECT_FALSE(device.read(now(), sample));
  ASSERT_TRUE(comes([&] {
    say({0.0, 0.0, 0.0});
    return device.read(now(), sample);
  }));
  EXPECT_EQ(sample.position, Vec3(7.0, 8.0, 9.0));
}

// By which the safety stage judges reach and speed.
TEST_F(PlacedDeviceTest, TellsWhereTheHandIsInItsOwnFrame) {
  LinkedDevice linked(link_);
  Placement placement = placement_;
  placement.scale = 3.0;
  placement.surface = Vec4{0.0, 0.0, 1.0, 0.0};
  PlacedDevice device(linked, {}, placement, {});
  DeviceSample sample;
  say({0.051, 0.0, 0.02});
  ASSERT_TRUE(comes([&] { return device.read(now(), sample); }));
  EXPECT_EQ(sample.hand, Vec3(0.051, 0.0, 0.02));
}

TEST_F(PlacedDeviceTest, IsSteeredByValuatorsWithinTheData) {
  LinkedDevice linked(link_);
  const Box bounds{{0.0, 1.0, 2.0}, {1.5, 3.0, 4.0}};
  PlacedDevice device(linked, {}, placement_, bounds);
  // Half pushed to the right, fully upwards.
  link_->say({.time = now() + 100.0, .has_valuators = true, .valuators = {0.5, 1.0, 0.0, 0.0, 0.0, 0.0}});
  DeviceSample sample;
  const double start = now();
  ASSERT_TRUE(comes([&] { return device.read(start, sample); }));
  EXPECT_EQ(sample.position, placement_.middle);
  ASSERT_TRUE(device.read(start + 0.02, sample));
  const double step = 0.02 * PlacedDevice::kTopSpeed;
  EXPECT_LT(glm::distance(sample.position, placement_.middle + Vec3{0.25 * step, 0.0, step}), 1e-12);
  EXPECT_EQ(sample.time, start + 0.02);
  for (int n = 0; n < 1000; ++n) ASSERT_TRUE(device.read(start + 0.02 * (n + 2), sample));
  EXPECT_EQ(sample.position.x, 1.5);
  EXPECT_EQ(sample.position.z, 4.0);
}

// What a head's tracker tells, as a head that is followed gets it: each pose once, and that it is not seen.
TEST_F(PlacedDeviceTest, TellsThePosesOfAStation) {
  link_->tracks_ = true;
  const auto tracker = std::make_shared<LinkedDevice>(link_);
  StationPoses poses(tracker, 3);
  PoseSample sample;
  const double first = now();
  PoseAtom atom{.time = first, .position = {0.1, 0.2, 0.6}, .station = 3, .valid = true};
  link_->show(atom);
  ASSERT_TRUE(comes([&] { return poses.next(now(), sample) && sample.pose; }));
  EXPECT_EQ(sample.time, first);
  EXPECT_EQ(sample.pose->position, Vec3(0.1, 0.2, 0.6));
  EXPECT_FALSE(poses.next(first, sample)) << "once";
  EXPECT_TRUE(poses.live());
  // Too old to be seen still.
  ASSERT_TRUE(poses.next(first + 1.0, sample));
  EXPECT_FALSE(sample.pose.has_value());
  EXPECT_EQ(sample.time, first + 1.0);
}

}  // namespace
}  // namespace palpate::test
