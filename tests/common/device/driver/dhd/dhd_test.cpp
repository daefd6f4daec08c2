// The link to Force Dimension's devices, over a library that the tests make, in simulated time.

#include <cstdlib>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/device/driver/dhd/dhd_link.h"
#include "common/servo/safety_stage.h"
#include "tests/common/device/driver/fake_dhd.h"
#include "tests/common/device/driver/moved_clock.h"
#include "tests/common/device/driver/round_with.h"
#include "tests/common/device/driver/soak.h"
#include "tests/support/project_folders.h"

namespace palpate::test {
namespace {

std::string library(const char* name) {
  return (build_folder() / "tests" / ("libpalpate_fake_" + std::string(name) + ".so")).string();
}

template <class Work>
std::string refusal(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

constexpr double kNoticed = 0.100;  // [s] within which an unplugged device is given up
const Vec3 kForce{0.5, -1.0, 1.5};  // [N]

class DhdLinkTest : public ::testing::Test {
 protected:
  DhdLinkTest() : functions_(open_dhd_library(library("dhd"))), fake_(*fake_dhd_of(library("dhd"))) {
    fake_ = FakeDhd();
    fake_.wanders = false;
    fake_.now = [this] { return clock_.now(); };
    settings_.arm.enabling_button = 0;
    link_ = std::make_unique<DhdLink>(functions_, clock_, settings_);
  }
  ~DhdLinkTest() override {
    link_.reset();
    fake_ = FakeDhd();
  }

  void run(double seconds, const Vec3& force) {
    for (const double until = clock_.now() + seconds; clock_.now() < until;) {
      (void)round_with(*link_, force);
      // The hand lives on whether it is asked or not.
      fake_.arm.advance(clock_.now());
    }
  }
  void get_ready() {
    run(0.1, Vec3{0.0});
    ASSERT_EQ(link_->status().phase, LinkPhase::kReady) << link_->advice();
  }
  /// What the hand feels of the motors now: none with a command of none, or with the force switched off.
  [[nodiscard]] bool silent() const { return fake_.arm.force() == Vec3{0.0}; }

  DhdFunctions functions_;
  FakeDhd& fake_;
  MovedClock clock_;
  DhdSettings settings_;
  std::unique_ptr<DhdLink> link_;
};

TEST(DhdLibrary, SaysWhatToInstall) {
  const std::string none = refusal([] { (void)open_dhd_library(""); });
  EXPECT_NE(none.find("install Force Dimension's SDK"), std::string::npos) << none;
  EXPECT_NE(none.find("libdhd.so"), std::string::npos) << none;
  EXPECT_EQ(none.find('\n'), std::string::npos) << "one line";
  const std::string missing = refusal([] { (void)open_dhd_library("/nowhere/libdhd.so"); });
  EXPECT_NE(missing.find("/nowhere/libdhd.so"), std::string::npos) << missing;
  const std::string old = refusal([] { (void)open_dhd_library(library("dhd_old")); });
  EXPECT_NE(old.find("is version 2.17"), std::string::npos) << old;
  const std::string partial = refusal([] { (void)open_dhd_library(library("dhd_partial")); });
  EXPECT_NE(partial.find("has no function dhdSetForce"), std::string::npos) << partial;
  const std::string other = refusal([] { (void)open_dhd_library("libm.so.6"); });
  EXPECT_NE(other.find("has no function dhdGetSDKVersion"), std::string::npos) << other;
}

TEST(DhdOptions, AreChecked) {
  const DhdSettings settings = dhd_settings({{"library", "/a/libdhd.so"}, {"serial", "12"}, {"cap", "3"}});
  EXPECT_EQ(settings.file, "/a/libdhd.so");
  EXPECT_EQ(settings.serial, 12);
  EXPECT_EQ(settings.arm.limits().force_cap, 3.0);
  for (const auto& [name, value] : DriverOptions{{"cap", "0"},
                                                 {"cap", "x"},
                                                 {"cap", "1e300"},
                                                 {"reach", "1e300"},
                                                 {"reach", "-1"},
                                                 {"serial", "1.5"},
                                                 {"serial", "70000"},
                                                 {"axes", "xyy"},
                                                 {"axes", "xzy"},
                                                 {"axes", "xy"},
                                                 {"axes", "xyzx"},
                                                 {"middle_x", "nan"},
                                                 {"gain", "1"}}) {
    EXPECT_THROW((void)dhd_settings({{name, value}}), Error) << name << "=" << value;
  }
  EXPECT_NE(dhd_help().find("default yzx"), std::string::npos);
}

TEST_F(DhdLinkTest, TurnsPositionsAndForcesBetweenTheFrames) {
  get_ready();
  fake_.arm.put({0.01, -0.02, 0.004});
  fake_.arm.set_target({0.01, -0.02, 0.004});
  fake_.buttons = 5;
  run(0.1, Vec3{0.0});
  EXPECT_NEAR(glm::distance(link_->atoms().position, {0.01, -0.02, 0.004}), 0.0, 1e-12);
  EXPECT_EQ(link_->atoms().buttons, 5U);
  run(0.01, kForce);
  EXPECT_NEAR(glm::distance(fake_.last, kForce), 0.0, 1e-12) << "the fake's own axes tell";
  EXPECT_EQ(link_->place(), "dhd 0 omega.3");
  EXPECT_EQ(link_->limits().force_cap, 8.0);
}

TEST_F(DhdLinkTest, HoldsEveryForceToTheCapOfUserModelAndMaker) {
  get_ready();
  run(0.05, {100.0, 0.0, 0.0});
  EXPECT_NEAR(glm::length(fake_.last), 8.0, 1e-12);
  run(0.01, {0.0, HUGE_VAL, 0.0});
  EXPECT_EQ(fake_.last, Vec3(0.0));
  run(0.01, {0.0, std::nan(""), 0.0});
  EXPECT_EQ(fake_.last, Vec3(0.0));
  fake_.plugged = false;
  run(0.2, Vec3{0.0});
  fake_.plugged = true;
  fake_.max_force = 2.0;
  get_ready();
  run(0.05, {0.0, 3.0, -4.0});
  EXPECT_NEAR(glm::distance(fake_.last, {0.0, 1.2, -1.6}), 0.0, 1e-12);
}

// The whole way: its button, the link, the safety stage, the motors.
TEST_F(DhdLinkTest, ShowsForceOnlyWhileItsSwitchIsHeld) {
  get_ready();
  SafetyStage stage(link_->limits());
  Vec3 force{0.0};
  double last = clock_.now();
  const auto step = [&] {
    (void)round_with(*link_, force);
    const DeviceAtoms& atoms = link_->atoms();
    force = stage.apply({.force = {0.0, 0.0, 2.0},
                         .dt = clock_.now() - last,
                         .age = clock_.now() - atoms.time,
                         .position = atoms.position,
                         .buttons = atoms.buttons});
    last = clock_.now();
  };
  for (int n = 0; n < 1000; ++n) step();
  EXPECT_TRUE(silent()) << "never held";
  fake_.buttons = 1;
  for (int n = 0; n < 1500; ++n) step();
  ASSERT_NEAR(fake_.arm.force().z, 2.0, 1e-9);
  const double lost = clock_.now();
  fake_.buttons = 0;
  while (!silent() && clock_.now() < lost + 1.0) step();
  EXPECT_LT(clock_.now() - lost, kNoticed);
  EXPECT_GT(clock_.now() - lost, 0.5 * DeviceLimits{}.fade_time) << "it fades, the hand leans on it";
}

TEST_F(DhdLinkTest, AsksForTheWatchdogAndIsGuardedByIt) {
  get_ready();
  EXPECT_EQ(fake_.watchdog, 160);
  run(0.05, kForce);
  ASSERT_FALSE(silent());
  // The program stands still: nobody sends anything.
  const double stalled = clock_.now();
  clock_.sleep(0.5);
  double x = 0.0;
  (void)functions_.position(&x, &x, &x, 0);
  EXPECT_TRUE(silent());
  EXPECT_NEAR(fake_.last_time, stalled, 0.002);
  // It goes on as if nothing had been: there is no force until none was asked for.
  run(0.3, kForce);
  EXPECT_TRUE(silent());
  EXPECT_GT(link_->status().faults, 0U);
  EXPECT_NE(link_->advice().find("let go of the switch"), std::string::npos);
  run(0.1, Vec3{0.0});
  run(0.1, kForce);
  EXPECT_FALSE(silent());
}

TEST_F(DhdLinkTest, TheLastCommandOnAnyFaultIsZero) {
  using Fault = void (*)(FakeDhd&);
  const std::array<std::pair<const char*, Fault>, 7> faults{{
      {"errors", [](FakeDhd& dhd) { dhd.failing_calls = 3; }},
      {"nonsense", [](FakeDhd& dhd) { dhd.nonsense = true; }},
      {"jump",
       [](FakeDhd& dhd) {
         dhd.arm.put({0.08, 0.0, 0.0});
       }},
      {"lost its zero", [](FakeDhd& dhd) { dhd.has_zero = false; }},
      {"no power", [](FakeDhd& dhd) { dhd.powered = false; }},
      {"throws", [](FakeDhd& dhd) { dhd.throwing_calls = 2; }},
      {"broken", [](FakeDhd& dhd) { dhd.broken = true; }},
  }};
  for (const auto& [name, fault] : faults) {
    fake_.failing_calls = 0;
    fake_.nonsense = fake_.broken = false;
    fake_.powered = fake_.has_zero = true;
    run(0.5, Vec3{0.0});
    get_ready();
    run(0.2, kForce);
    ASSERT_FALSE(silent()) << name;
    fault(fake_);
    // The status is looked at some times a second; the rest is known at once.
    const double before = clock_.now();
    bool silenced = false;
    while (clock_.now() < before + kNoticed) {
      (void)round_with(*link_, kForce);
      silenced = silenced || silent();
    }
    EXPECT_TRUE(silenced) << name;
  }
}

// An omega.7 has no button, but a gripper that closes: the switch of its force.
TEST_F(DhdLinkTest, AClosedGripperIsTheFirstButton) {
  const auto after = [this](int type) {
    fake_.plugged = false;
    run(0.3, Vec3{0.0});
    fake_.plugged = true;
    fake_.gripper_is_button = false;
    fake_.type = type;
    get_ready();
    return fake_.gripper_is_button;
  };
  for (const int type : {35, 37, 104, 105, 108, 109}) EXPECT_TRUE(after(type)) << type;
  for (const int type : {33, 34, 63, 203, 206, 60}) EXPECT_FALSE(after(type)) << type;
  ASSERT_TRUE(after(35));
  EXPECT_EQ(link_->atoms().buttons, 0U);
  fake_.closed_gripper = true;
  run(0.01, Vec3{0.0});
  EXPECT_EQ(link_->atoms().buttons, 1U);
  EXPECT_EQ(link_->advice(), "");
  // A library that is too old for that says so.
  functions_.emulate_button = nullptr;
  link_ = nullptr;
  link_ = std::make_unique<DhdLink>(functions_, clock_, settings_);
  fake_.type = 104;
  get_ready();
  EXPECT_NE(link_->advice().find("enable=pedal"), std::string::npos) << link_->advice();
}

TEST_F(DhdLinkTest, TimeGuardAndSaturationAreNoFaults) {
  get_ready();
  fake_.repeated_calls = 500;
  run(0.2, kForce);
  EXPECT_FALSE(silent());
  EXPECT_EQ(link_->status().faults, 0U);
}

TEST_F(DhdLinkTest, TellsWhoeverWaitsWhatToDo) {
  fake_.has_zero = false;
  run(0.2, kForce);
  EXPECT_EQ(link_->status().phase, LinkPhase::kNeedsHoming);
  EXPECT_NE(link_->advice().find("no zero yet"), std::string::npos);
  EXPECT_TRUE(silent());
  fake_.powered = false;
  run(0.2, kForce);
  EXPECT_NE(link_->advice().find("no power"), std::string::npos);
  fake_.powered = fake_.has_zero = true;
  get_ready();
  fake_.switch_force_off(1);
  run(0.2, Vec3{0.0});
  EXPECT_NE(link_->advice().find("force button"), std::string::npos);
  EXPECT_FALSE(fake_.force_on) << "that button is the user's";
  link_.reset();
  fake_.busy = true;
  link_ = std::make_unique<DhdLink>(functions_, clock_, settings_);
  run(0.3, Vec3{0.0});
  EXPECT_EQ(link_->status().phase, LinkPhase::kRefused);
  EXPECT_NE(link_->advice().find("device in use"), std::string::npos);
}

TEST_F(DhdLinkTest, NoticesAtOnceThatItIsUnpluggedAndComesBack) {
  for (int n = 0; n < 5; ++n) {
    get_ready();
    run(0.05 + 0.0007 * n, kForce);
    ASSERT_FALSE(silent());
    const double pulled = clock_.now();
    fake_.plugged = false;
    while (link_->status().phase == LinkPhase::kReady && clock_.now() < pulled + 1.0)
      (void)round_with(*link_, kForce);
    EXPECT_LT(clock_.now() - pulled, kNoticed);
    EXPECT_EQ(fake_.opened, fake_.closed);
    EXPECT_EQ(link_->place(), "");
    run(0.3, kForce);
    EXPECT_EQ(link_->status().phase, LinkPhase::kAbsent);
    fake_.plugged = true;
    run(0.5, kForce);
    EXPECT_EQ(link_->status().phase, LinkPhase::kReady);
    EXPECT_TRUE(silent()) << "the hand leans on it all the while";
    run(0.01, Vec3{0.0});
  }
  link_.reset();
  EXPECT_EQ(fake_.opened, fake_.closed);
  EXPECT_TRUE(silent());
}

// All that can go wrong, over and over, for as long as PALPATE_SOAK_SECONDS says [s of simulated time].
TEST_F(DhdLinkTest, BearsEveryFaultForLong) {
  const double seconds = soak_seconds(1200.0);
  Soak soak(11);
  std::uint64_t fresh = 0;
  while (clock_.now() < seconds && !HasFailure()) {
    if (soak.chance(0.2)) fake_.failing_calls = static_cast<int>(soak.below(20));
    if (soak.chance(0.2)) fake_.repeated_calls = static_cast<int>(soak.below(50));
    if (soak.chance(0.1)) fake_.switch_force_off(static_cast<int>(1 + soak.below(6)));
    if (soak.chance(0.1)) fake_.arm.put(soak.within(0.16));
    if (soak.chance(0.05)) fake_.throwing_calls = static_cast<int>(soak.below(4));
    fake_.nonsense = soak.chance(0.05);
    fake_.broken = soak.chance(0.05);
    fake_.powered = !soak.chance(0.05);
    fake_.has_zero = !soak.chance(0.05);
    fake_.plugged = !soak.chance(0.05);
    fake_.busy = soak.chance(0.05);
    fake_.arm.set_target(soak.within(0.04));
    fresh += soak.work(
        *link_, [&] { return clock_.now(); }, 0.3, soak.force(20.0),
        [&] { return fake_.opened - fake_.closed; });
    ASSERT_LE(fake_.arm.largest_force(), 8.0 + 1e-9);
    ASSERT_LE(fake_.wire.excess(), 1e-9);
  }
  EXPECT_GT(fresh, static_cast<std::uint64_t>(100.0 * seconds));
  EXPECT_GT(link_->status().faults, 10U);
  fake_.nonsense = fake_.broken = fake_.busy = false;
  fake_.powered = fake_.has_zero = fake_.plugged = true;
  fake_.failing_calls = fake_.throwing_calls = 0;
  run(1.0, Vec3{0.0});
  get_ready();
  link_.reset();
  EXPECT_TRUE(silent());
  EXPECT_EQ(fake_.opened, fake_.closed);
}

}  // namespace
}  // namespace palpate::test
