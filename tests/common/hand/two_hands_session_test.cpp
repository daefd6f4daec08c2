// Tracked hands in a session, in place of the mouse: the stylus is the probe, the other hand carries the
// plane. The time of the hands is the test's; every wait is for an event, and gives up after half a minute.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "common/field/analytic/volume_examples.h"
#include "common/hand/mode/grid_mode.h"
#include "common/hand/probe_session.h"

namespace palpate::test {
namespace {

const Quat kTurn = rotation_by({40.0 * kDegree, 0.0, 0.0});

/// The other hand holds its button from 0.2 s to 0.8 s and turns by kTurn meanwhile; the stylus rests.
std::vector<TrackedHands> recording() {
  std::vector<TrackedHands> all;
  for (int i = 0; i <= 200; ++i) {
    const double part = std::clamp((i - 60) / 60.0, 0.0, 1.0);
    TrackedHands hands{.time = 5.0 + 0.005 * i, .carries = i >= 40 && i < 160};
    hands.stylus = TrackerPose{{0.12, 0.2, 0.3}, identity_rotation()};
    hands.other = TrackerPose{{0.1, 0.2, 0.3}, rotation_by({40.0 * kDegree * part, 0.0, 0.0})};
    all.push_back(hands);
  }
  return all;
}

class TwoHandsSession : public ::testing::Test {
 protected:
  TwoHandsSession() : session_(options(), [] {}) {
    static const DataSet data = volume_example("blob");
    static const auto field = make_scalar_field({data}, {kVolumeArray, Association::kPoint, 0}, "blob", 1);
    (void)session_.set_field({.name = "blob", .scalar = field});
    scale_ = Workspace::default_scale(field->diagonal());
  }

  void frame() {
    session_.update(time_, camera_, LineStyle{}, view_);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  /// Frames without the hands going on.
  [[nodiscard]] bool wait_for(const std::function<bool()>& happened) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    do {
      frame();
      if (happened()) return true;
    } while (std::chrono::steady_clock::now() < end);
    return false;
  }
  void go_on(double seconds) {
    for (double end = time_ + seconds; time_ < end; time_ += 0.005) frame();
  }
  [[nodiscard]] bool plane_is_at(const Vec3& normal) const {
    return session_.planes() && glm::distance(axes_of(session_.planes()->poses.pose[0])[2], normal) < 1e-12;
  }
  [[nodiscard]] bool plane_comes_to(const Vec3& normal) {
    return wait_for([&] { return plane_is_at(normal); });
  }

  ProbeSession session_;
  double scale_ = 0.0, time_ = 100.0;

 private:
  static ProbeSessionOptions options() {
    ProbeSessionOptions options;
    options.modes = {find_mode(modes_of(FieldKind::kScalar), kPlaneWidgetMode)};
    options.workbench.interaction = {.immersive = true, .middle = {0.1, 0.2, 0.3}, .gain = 2.0};
    options.hands = recording();
    return options;
  }

  Camera camera_ = make_camera({Vec3{-1.0}, Vec3{1.0}}, {}, 1.5);
  ProbeView view_;
};

TEST_F(TwoHandsSession, TheStylusIsTheProbeAndTheMouseIsNot) {
  // 20 mm of the hand are 40 mm of the workspace.
  const double x = 0.04 / scale_;
  EXPECT_TRUE(wait_for([&] {
    return session_.readout().held && std::abs(session_.readout().probe.x - x) < 1e-9;
  })) << session_.readout().probe.x;
  EXPECT_FALSE(session_.hand().by_mouse());
  session_.grab(time_, Vec3{0.9});
  session_.hand().lead(MouseDrag{100.0, 0.0}, {}, {300, 200});
  EXPECT_NEAR(session_.hand().intent().probe.x, x, 1e-9);
  // When the recording is over, so is the hand.
  go_on(1.2);
  EXPECT_TRUE(wait_for([&] { return !session_.readout().held; }));
}

TEST_F(TwoHandsSession, TheOtherHandCarriesThePlaneWhichIsRestoredFromTheDocument) {
  const Vec3 up{0.0, 0.0, 1.0};
  ASSERT_TRUE(plane_comes_to(up));
  TouchOptions before;
  session_.keep(before);
  go_on(0.45);
  EXPECT_TRUE(wait_for([&] { return axes_of(session_.planes()->poses.pose[0])[2] != up; })) << "on its way";
  EXPECT_FALSE(plane_is_at(kTurn * up));
  go_on(0.5);
  EXPECT_TRUE(plane_comes_to(kTurn * up));
  session_.restore(before);
  EXPECT_TRUE(plane_comes_to(up));
}

}  // namespace
}  // namespace palpate::test
