// What a calibration makes of a device's own word: an arm by its joints, a tracker by its correction, and the
// force that waits until both were seen to fit.

#include "common/device/calibrated_link.h"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "tests/common/device/driver/round_with.h"

namespace palpate::test {
namespace {

/// An arm of three joints that says whatever the test wants.
class SayingLink final : public DriverLink {
 public:
  bool round() noexcept override {
    const Vec3 force = ordered();
    shown = force;
    return true;
  }
  [[nodiscard]] const DeviceAtoms& atoms() const noexcept override { return said; }
  [[nodiscard]] const PoseAtoms* poses() const noexcept override { return tracks ? &seen : nullptr; }
  [[nodiscard]] Rigid device_from_poses() const noexcept override { return lies; }
  [[nodiscard]] const LinkStatus& status() const noexcept override { return state; }
  [[nodiscard]] std::string advice() const override { return {}; }
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return bounds; }
  [[nodiscard]] std::string place() const override { return "here"; }

  DeviceAtoms said{.has_position = true};
  PoseAtoms seen;
  LinkStatus state{.phase = LinkPhase::kReady, .opened = 1};
  DeviceLimits bounds;
  Rigid lies;
  bool tracks = false;
  Vec3 shown{0.0};
};

/// Three sliding joints would be simpler, but rows turn: two links of 0.3 m in a plane, and a third that
/// turns the end.
DhhChain plane_arm() {
  DhhChain arm;
  arm.joint_count = 3;
  for (int joint = 0; joint < 3; ++joint)
    arm.rows.push_back({.values = {0.0, joint < 2 ? 0.3 : 0.0, 0.0, 0.0, 0.0}, .joint = joint});
  return arm;
}

constexpr Vec3 kForce{0.0, 0.0, 1.0};

class CalibratedArm : public ::testing::Test {
 protected:
  CalibratedArm() {
    auto link = std::make_unique<SayingLink>();
    link_ = link.get();
    link_->said.joint_count = 3;
    LinkCalibration calibration{.arm = plane_arm()};
    // Frame 0 lies in D as it is, its elbow at a right angle in the middle.
    calibration.device_from_arm = {identity_rotation(), Vec3{-0.3, -0.3, 0.0}};
    tell(0.0, {});
    calibrated_ = std::make_unique<CalibratedLink>(std::move(link), calibration);
  }
  /// The base at `base`, and the device's own word of where its end is.
  void tell(double base, const Vec3& own) {
    link_->said.joints = {base, 0.5 * 3.14159265358979323846, 0.0};
    link_->said.position = own;
  }
  /// By hand: the end of the arm turned about its base.
  static Vec3 end_at(double base) {
    return {0.3 * std::cos(base) - 0.3 * std::sin(base) - 0.3,
            0.3 * std::sin(base) + 0.3 * std::cos(base) - 0.3, 0.0};
  }

  SayingLink* link_ = nullptr;
  std::unique_ptr<CalibratedLink> calibrated_;
};

TEST_F(CalibratedArm, IsWhereItsJointsSayOnceBothMoveAlikeItGetsForce) {
  for (const double base : {0.0, 0.02, 0.1, -0.1}) {
    // The maker is 40 mm and 5 degrees off.
    tell(base, rotation_by({0.0, 0.0, 0.09}) * end_at(base) + Vec3(0.04, 0.0, 0.0));
    EXPECT_TRUE(round_with(*calibrated_, kForce));
    EXPECT_LT(glm::distance(calibrated_->atoms().position, end_at(base)), 1e-15);
    EXPECT_EQ(calibrated_->advice().empty(), base == 0.1 || base == -0.1) << base;
  }
  (void)round_with(*calibrated_, kForce);
  EXPECT_EQ(link_->shown, kForce);
  // What is plugged in anew may be another one.
  ++link_->state.opened;
  (void)round_with(*calibrated_, kForce);
  (void)round_with(*calibrated_, kForce);
  EXPECT_EQ(link_->shown, Vec3(0.0));
  EXPECT_NE(calibrated_->advice().find("move the arm"), std::string::npos);
}

TEST_F(CalibratedArm, GetsNoForceWhereBothMoveAnotherWay) {
  const auto shown = [&](const Quat& turn, double factor) {
    ++link_->state.opened;
    for (const double base : {0.0, 0.05, 0.1, 0.15}) {
      tell(base, factor * (turn * end_at(base)));
      (void)round_with(*calibrated_, kForce);
    }
    return link_->shown != Vec3(0.0);
  };
  EXPECT_TRUE(shown(identity_rotation(), 1.0));
  EXPECT_TRUE(shown(rotation_by({0.0, 0.4, 0.0}), 1.0));
  EXPECT_FALSE(shown(rotation_by({0.0, 0.0, 0.7}), 1.0));
  EXPECT_NE(calibrated_->advice().find("arm_rotation"), std::string::npos) << calibrated_->advice();
  EXPECT_FALSE(shown(identity_rotation(), -1.0));
  EXPECT_FALSE(shown(identity_rotation(), 2.5));
  EXPECT_FALSE(shown(identity_rotation(), 0.3));
}

TEST(CalibratedTracker, MovesAProbeByItsCorrectedTip) {
  auto link = std::make_unique<SayingLink>();
  SayingLink& tracker = *link;
  tracker.tracks = true;
  // The tracker's x is up in D, and its z right.
  tracker.lies = {Quat{0.5, 0.5, 0.5, 0.5}, Vec3{0.1, 0.2, 0.3}};
  const Quat turned = rotation_by({0.0, 0.0, 0.5});
  tracker.said.station = 2;
  tracker.seen.stations[1] = {
      .position = {1.0, 2.0, 3.0}, .orientation = turned, .station = 2, .valid = true};
  LinkCalibration calibration{.tip = Vec3{0.0, 0.0, -0.1}};
  ASSERT_FALSE(CalibratedLink::concerns(tracker, {.arm = plane_arm()}));
  ASSERT_TRUE(CalibratedLink::concerns(tracker, calibration));
  TrackerCorrection shifted;
  shifted.position = {.degree = 0, .center = Vec3{0.0}, .scale = 1.0, .coefficients = {Vec3{0.01, 0.0, 0.0}}};
  shifted.orientation = {.degree = 0, .center = Vec3{0.0}, .scale = 1.0, .coefficients = {Vec3{0.0}}};
  calibration.tracker = shifted;
  CalibratedLink calibrated(std::move(link), calibration);
  (void)round_with(calibrated, Vec3{0.0});
  const Vec3 tip{1.01, 2.0, 2.9};  // the turn is about the stylus
  const Vec3 expected = tracker.lies * tip;
  EXPECT_LT(glm::distance(calibrated.atoms().position, expected), 1e-12);
  EXPECT_EQ(calibrated.poses()->stations[1].position, Vec3(1.0, 2.0, 3.0)) << "as reported";
}

}  // namespace
}  // namespace palpate::test
