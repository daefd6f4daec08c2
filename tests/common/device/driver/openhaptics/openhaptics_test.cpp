// The link over OpenHaptics, with a library that the tests make, in simulated time: its scheduler ticks when
// the clock moves.

#include <cstdlib>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/device/driver/openhaptics/hd_link.h"
#include "tests/common/device/driver/fake_hd.h"
#include "tests/common/device/driver/moved_clock.h"
#include "tests/common/device/driver/round_with.h"
#include "tests/common/device/driver/soak.h"
#include "tests/support/project_folders.h"

namespace palpate::test {
namespace {

std::string library() { return (build_folder() / "tests/libpalpate_fake_hd.so").string(); }

constexpr double kNoticed = 0.100;  // [s] within which an unplugged device is given up
const Vec3 kForce{0.5, -1.0, 1.5};  // [N]

class HdLinkTest : public ::testing::Test {
 protected:
  HdLinkTest() : functions_(open_hd_library(library())), fake_(*fake_hd_of(library())) {
    reset_fake();
    fake_.by_itself = false;
    clock_.while_time_passes([this] {
      // Its scheduler ticks a thousand times a second.
      if (clock_.now() - ticked_ < 0.000999) return;
      ticked_ = clock_.now();
      fake_.tick(ticked_);
    });
    link_ = std::make_unique<HdLink>(functions_, clock_, HdSettings());
  }
  ~HdLinkTest() override {
    link_.reset();
    clock_.while_time_passes(nullptr);
    reset_fake();
  }

  void reset_fake() {
    auto* const tick = fake_.tick;
    fake_ = FakeHd();
    fake_.tick = tick;
  }
  void run(double seconds, const Vec3& force) {
    for (const double until = clock_.now() + seconds; clock_.now() < until;) (void)round_with(*link_, force);
  }
  void get_ready() {
    run(0.1, Vec3{0.0});
    ASSERT_EQ(link_->status().phase, LinkPhase::kReady) << link_->advice();
  }
  [[nodiscard]] bool silent() const { return fake_.arm.force() == Vec3{0.0}; }

  HdFunctions functions_;
  FakeHd& fake_;
  MovedClock clock_;
  double ticked_ = 0.0;
  std::unique_ptr<HdLink> link_;
};

TEST(HdLibrary, SaysWhatToInstall) {
  for (const char* file : {"", "/nowhere/libHD.so", "libm.so.6"}) {
    try {
      (void)open_hd_library(file);
      FAIL() << file;
    } catch (const Error& error) {
      const std::string line = error.what();
      EXPECT_NE(line.find("install OpenHaptics"), std::string::npos) << line;
      EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    }
  }
}

TEST(HdOptions, AreChecked) {
  const HdSettings settings = hd_settings({{"name", "Right arm"}, {"library", "l"}, {"middle_y", "0.05"}});
  EXPECT_EQ(settings.name, "Right arm");
  EXPECT_EQ(settings.arm.frame.position({0.0, 0.05, 0.0}), Vec3(0.0));
  EXPECT_THROW((void)hd_settings({{"serial", "1"}}), Error);
  EXPECT_NE(hd_help().find("default xyz"), std::string::npos);
}

TEST_F(HdLinkTest, ReadsMillimetresAndPushesInsideOfFrames) {
  get_ready();
  fake_.arm.put({0.01, -0.02, 0.004});
  fake_.arm.set_target({0.01, -0.02, 0.004});
  fake_.buttons = 3;
  run(0.1, Vec3{0.0});
  EXPECT_NEAR(glm::distance(link_->atoms().position, {0.01, -0.02, 0.004}), 0.0, 1e-12);
  EXPECT_EQ(link_->atoms().buttons, 3U);
  EXPECT_LE(clock_.now() - link_->atoms().time, 0.002);
  run(0.01, 0.2 * kForce);
  EXPECT_NEAR(glm::distance(fake_.last, 0.2 * kForce), 0.0, 1e-12);
  EXPECT_FALSE(fake_.out_of_frame);
  EXPECT_EQ(link_->place(), "hd 3 PHANTOM Omni");
}

// 3.3 N at most, 0.88 N for any time.
TEST_F(HdLinkTest, HoldsForcesToTheMakersPeakAndThenToWhatTheMotorsStand) {
  get_ready();
  run(0.020, {100.0, 0.0, 0.0});
  EXPECT_NEAR(fake_.last.x, 3.3, 0.1);
  EXPECT_LE(fake_.arm.largest_force(), 3.3);
  run(20.0, {100.0, 0.0, 0.0});
  EXPECT_NEAR(fake_.last.x, 0.88, 0.01);
  run(0.01, {std::nan(""), 1.0, 0.0});
  EXPECT_EQ(fake_.last, Vec3(0.0));
  // A maker's smaller peak holds, too.
  fake_.plugged = false;
  run(0.2, Vec3{0.0});
  fake_.plugged = true;
  fake_.most = 1.0;
  run(1.0, Vec3{0.0});
  get_ready();
  run(0.01, {0.0, 6.0, -8.0});
  EXPECT_NEAR(glm::distance(fake_.last, {0.0, 0.6, -0.8}), 0.0, 0.02);
}

// The program stands still while the library's thread goes on: the callback is its own watchdog.
TEST_F(HdLinkTest, AForceThatIsNotRenewedIsNone) {
  get_ready();
  run(0.1, 0.2 * kForce);
  ASSERT_FALSE(silent());
  clock_.sleep(HdLink::kFreshFor + 0.003);
  EXPECT_TRUE(silent());
}

TEST_F(HdLinkTest, TheLastCommandOnAnyFaultIsZero) {
  using Fault = void (*)(FakeHd&);
  const std::array<std::pair<const char*, Fault>, 7> faults{{
      {"throws", [](FakeHd& hd) { hd.throwing_calls = 1; }},
      {"warm motors", [](FakeHd& hd) { hd.error = 0x0200; }},
      {"too fast", [](FakeHd& hd) { hd.error = 0x0203; }},
      {"lost", [](FakeHd& hd) { hd.error = 0x0302; }},
      {"no zero", [](FakeHd& hd) { hd.calibrated = false; }},
      {"nonsense", [](FakeHd& hd) { hd.nonsense = true; }},
      {"jump",
       [](FakeHd& hd) {
         hd.arm.put({0.08, 0.0, 0.0});
       }},
  }};
  for (const auto& [name, fault] : faults) {
    fake_.error = 0;
    fake_.calibrated = true;
    fake_.nonsense = false;
    run(1.5, Vec3{0.0});
    get_ready();
    run(0.1, 0.2 * kForce);
    ASSERT_FALSE(silent()) << name;
    fault(fake_);
    bool silenced = false;
    for (const double until = clock_.now() + kNoticed; clock_.now() < until;) {
      (void)round_with(*link_, 0.2 * kForce);
      silenced = silenced || silent();
    }
    EXPECT_TRUE(silenced) << name;
  }
}

TEST_F(HdLinkTest, AfterAnErrorThereIsForceOnceNoneWasAskedFor) {
  get_ready();
  run(0.1, 0.2 * kForce);
  fake_.error = 0x0200;
  run(0.01, 0.2 * kForce);
  fake_.error = 0;
  run(1.0, 0.2 * kForce);
  EXPECT_TRUE(silent());
  EXPECT_NE(link_->advice().find("too warm"), std::string::npos);
  run(0.01, Vec3{0.0});
  run(0.1, 0.2 * kForce);
  EXPECT_FALSE(silent());
  EXPECT_EQ(link_->advice(), "");
}

TEST_F(HdLinkTest, CalibratesWhatCalibratesItselfAndWaitsForTheRest) {
  link_.reset();
  fake_.calibrated = false;
  fake_.updates_calibration = true;
  link_ = std::make_unique<HdLink>(functions_, clock_, HdSettings());
  get_ready();
  fake_.updates_calibration = fake_.calibrated = false;
  run(0.1, kForce);
  EXPECT_EQ(link_->status().phase, LinkPhase::kNeedsHoming);
  EXPECT_NE(link_->advice().find("inkwell"), std::string::npos);
}

TEST_F(HdLinkTest, SaysWhyItCannotBeOpened) {
  link_.reset();
  fake_.busy = true;
  link_ = std::make_unique<HdLink>(functions_, clock_, HdSettings());
  run(0.1, Vec3{0.0});
  EXPECT_EQ(link_->status().phase, LinkPhase::kRefused);
  EXPECT_NE(link_->advice().find("0x0301"), std::string::npos) << link_->advice();
  fake_.busy = false;
  HdSettings other;
  other.name = "Left arm";
  link_ = std::make_unique<HdLink>(functions_, clock_, other);
  run(0.1, Vec3{0.0});
  EXPECT_EQ(link_->status().phase, LinkPhase::kAbsent);
  other.name = "Right arm";
  link_ = std::make_unique<HdLink>(functions_, clock_, other);
  get_ready();
}

TEST_F(HdLinkTest, NoticesAtOnceThatItIsUnpluggedOrHungAndComesBack) {
  for (int n = 0; n < 6; ++n) {
    get_ready();
    run(0.05 + 0.0007 * n, 0.2 * kForce);
    ASSERT_FALSE(silent());
    const double pulled = clock_.now();
    (n % 2 == 0 ? fake_.plugged : fake_.hung) = n % 2 != 0;
    while (link_->status().phase == LinkPhase::kReady && clock_.now() < pulled + 1.0) {
      (void)round_with(*link_, 0.2 * kForce);
    }
    EXPECT_LT(clock_.now() - pulled, kNoticed);
    EXPECT_EQ(fake_.opened, fake_.closed);
    EXPECT_FALSE(fake_.force_output);
    EXPECT_FALSE(fake_.running);
    fake_.plugged = true;
    fake_.hung = false;
    run(1.5, 0.2 * kForce);
    EXPECT_EQ(link_->status().phase, LinkPhase::kReady);
    EXPECT_TRUE(silent()) << "the hand leans on it all the while";
    run(0.01, Vec3{0.0});
  }
  run(0.1, 0.2 * kForce);
  link_.reset();
  EXPECT_EQ(fake_.last, Vec3(0.0));
  EXPECT_EQ(fake_.opened, fake_.closed);
}

// All that can go wrong, over and over, for as long as PALPATE_SOAK_SECONDS says [s of simulated time].
TEST_F(HdLinkTest, BearsEveryFaultForLong) {
  const double seconds = soak_seconds(1200.0);
  Soak soak(12);
  std::uint64_t fresh = 0;
  while (clock_.now() < seconds && !HasFailure()) {
    fake_.error = soak.chance(0.15)   ? 0x0200U + static_cast<unsigned>(soak.below(5))
                  : soak.chance(0.05) ? 0x0302U
                                      : 0U;
    fake_.calibrated = !soak.chance(0.05);
    fake_.hung = soak.chance(0.05);
    fake_.plugged = !soak.chance(0.05);
    fake_.busy = soak.chance(0.05);
    fake_.nonsense = soak.chance(0.05);
    if (soak.chance(0.05)) fake_.throwing_calls = static_cast<int>(soak.below(3));
    if (soak.chance(0.1)) fake_.arm.put(soak.within(0.16));
    fake_.arm.set_target(soak.within(0.04));
    fresh += soak.work(
        *link_, [&] { return clock_.now(); }, 0.3, soak.force(20.0),
        [&] { return fake_.opened - fake_.closed; });
    ASSERT_LE(fake_.arm.largest_force(), 3.3 + 1e-9);
    ASSERT_LE(fake_.wire.excess(), 1e-9);
    ASSERT_FALSE(fake_.out_of_frame);
  }
  EXPECT_GT(fresh, static_cast<std::uint64_t>(50.0 * seconds));
  EXPECT_GT(link_->status().faults, 10U);
  fake_.error = 0;
  fake_.hung = fake_.busy = fake_.nonsense = false;
  fake_.throwing_calls = 0;
  fake_.calibrated = fake_.plugged = true;
  run(2.0, Vec3{0.0});
  get_ready();
  link_.reset();
  EXPECT_TRUE(silent());
  EXPECT_EQ(fake_.opened, fake_.closed);
}

}  // namespace
}  // namespace palpate::test
