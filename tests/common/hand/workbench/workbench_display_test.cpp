// Screens of a workbench: one place of the data for all of them, corners of each at the corners of its
// picture wherever the head is, and the latency that is told.

#include "common/hand/workbench/workbench_display.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/haptics/workspace.h"

namespace palpate {
namespace {

/// A wall and a table that is tilted before it.
WorkbenchGeometry two_screens() {
  WorkbenchGeometry workbench;
  workbench.screens.push_back(
      {.corners = {{-0.8, 0.0, 0.0}, {0.8, 0.0, 0.0}, {-0.8, 1.0, 0.0}}, .name = "wall"});
  workbench.screens.push_back(
      {.corners = {{-0.5, -0.1, 0.9}, {0.5, -0.1, 0.9}, {-0.5, 0.2, 0.2}}, .name = "table"});
  workbench.interaction.middle = {0.1, 0.3, 0.2};
  workbench.interaction.rotation = rotation_by({0.2, -0.4, 1.0});
  workbench.interaction.gain = 2.5;
  return workbench;
}

const Box kBox{Vec3(-1.0, -2.0, 0.5), Vec3(3.0, 1.0, 4.0)};

TEST(WorkbenchPlace, IsTheSameByTheFileAndByTheCameraThatItGives) {
  const WorkbenchGeometry workbench = two_screens();
  const WorkbenchPlace by_file =
      place_of(workbench.interaction, kBox.center(), Workspace::default_scale(kBox.diagonal()));
  for (const ScreenGeometry& screen : workbench.screens) {
    const WorkbenchPlace by_camera = place_of(workbench_camera(by_file, screen.corners), screen.corners);
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
    for (int i = 0; i < 100; ++i) {
      const Vec3 q{anywhere(random), anywhere(random), anywhere(random)};
      EXPECT_LT(glm::distance(by_file(q), by_camera(q)), 1e-12 * kBox.diagonal());
    }
  }
}

TEST(WorkbenchDisplay, ShowsEachScreenCornerToCornerFromAnyHead) {
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  double worst = 0.0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 head{0.6 * anywhere(random), 0.8 + 0.3 * anywhere(random), 0.9 + 0.3 * anywhere(random)};
    WorkbenchDisplayOptions options{.workbench = two_screens(),
                                    .head = std::make_shared<RestingPose>(TrackerPose{
                                        head, rotation_by({0.3 * anywhere(random), anywhere(random), 0.0})})};
    WorkbenchDisplay display(options);
    SceneView view;
    view.bounds = kBox;
    view.camera = display.camera(kBox, 0.0);
    // The mouse has turned, moved and enlarged the data meanwhile.
    turn(view.camera, anywhere(random), anywhere(random));
    zoom(view.camera, 1.3, 0.1, -0.2);
    view.stereo.mode = StereoMode::kSideBySide;
    view.stereo.most_disparity = 3.0;  // [rad]: eyes stay where they are
    display.follow(1.0);
    const WorkbenchPlace place = place_of(view.camera, display.screen());
    for (const ScreenGeometry& screen : options.workbench.screens) {
      SceneView seen = view;
      display.show(screen.corners, seen);
      const auto cameras = stereo_eyes(seen.camera, seen.stereo, seen.bounds).cameras;
      constexpr int kHeight = 1000;
      const double aspect = width(screen.corners) / height(screen.corners);
      const int pixels = static_cast<int>(std::lround(kHeight * aspect));
      for (std::size_t e = 0; e < 2; ++e) {
        EXPECT_LT(glm::distance(eye(cameras[e]), place(display.eyes()[e])), 1e-9);
        const Vec3 corner = project(cameras[e], place(screen.corners.lower_left), pixels, kHeight);
        const Vec3 other = project(cameras[e], place(screen.corners.upper_left), pixels, kHeight);
        worst = std::max(
            {worst, std::abs(corner.x), std::abs(corner.y - kHeight), std::abs(other.x), std::abs(other.y)});
      }
    }
  }
  EXPECT_LT(worst, 0.5) << "pixels, of which one is lost to the shape of the table's picture";
}

// A window that covers a part of its screen shows that part, and the data stays where it is.
TEST(WorkbenchDisplay, CoversAPartOfAScreenByItsPixels) {
  WorkbenchDisplayOptions options{.workbench = two_screens(),
                                  .head = std::make_shared<RestingPose>(TrackerPose{{0.0, 0.5, 1.0}, {}})};
  options.workbench.screens[0].pixels = {1600, 1000};
  options.workbench.screens[0].position = {100, 0};
  WorkbenchDisplay display(options);
  Camera camera = display.camera(kBox, 0.0);
  const WorkbenchPlace before = place_of(camera, display.screen());
  EXPECT_TRUE(display.cover(300.0, 100.0, 800.0, 600.0, camera));
  EXPECT_FALSE(display.cover(300.0, 100.0, 800.0, 600.0, camera));
  const Screen& part = display.screen();
  EXPECT_LT(glm::distance(part.upper_left, Vec3(-0.6, 0.9, 0.0)), 1e-12);
  EXPECT_LT(glm::distance(part.lower_right, Vec3(0.2, 0.3, 0.0)), 1e-12);
  const WorkbenchPlace after = place_of(camera, part);
  for (const Vec3& q : {Vec3(0.0), Vec3(0.3, -0.2, 0.7)})
    EXPECT_LT(glm::distance(before(q), after(q)), 1e-12 * kBox.diagonal());
}

TEST(WorkbenchDisplay, TakesAnEyeBesideAScreenToBeJustBeforeIt) {
  const Screen screen{{-0.5, -0.5, 0.0}, {0.5, -0.5, 0.0}, {-0.5, 0.5, 0.0}};
  SceneView view;
  view.bounds = kBox;
  look_through(screen, {Vec3(2.0, 0.0, -0.3), Vec3(2.0, 0.0, 0.4)}, view);
  EXPECT_NEAR(eye(view.camera).z, 0.1, 1e-12);
  EXPECT_NEAR(eye(view.camera).x, 2.0, 1e-12);
}

/// A tracker whose samples are a hundredth of a second old when they come.
class LateHead final : public PoseSource {
 public:
  bool next(double now, PoseSample& sample) override {
    if (now <= last_) return false;
    last_ = now;
    sample = {now - 0.01, TrackerPose{{0.0, 0.5, 1.0 + 0.2 * (now - 0.01)}, {}}};
    return true;
  }
  [[nodiscard]] bool live() const override { return true; }

 private:
  double last_ = 0.0;
};

TEST(WorkbenchDisplay, MeasuresTheLatencyAndLooksAheadByIt) {
  WorkbenchDisplayOptions options{.workbench = two_screens(), .head = std::make_shared<LateHead>()};
  options.workbench.head.sensor_latency = 0.005;
  options.workbench.head.display_latency = 0.008;
  WorkbenchDisplay display(options);
  EXPECT_EQ(display.latency(), 0.0);
  double now = 1.0;
  for (int i = 0; i < 40; ++i, now += 0.03) {
    display.follow(now);
    display.finished(now + 0.02);
  }
  now -= 0.03;
  // 5 ms before the sample's time, 10 ms old, a picture of 20 ms, light after 8 ms.
  EXPECT_NEAR(display.latency(), 0.043, 1e-12);
  const double z = 0.5 * (display.eyes()[0].z + display.eyes()[1].z);
  EXPECT_NEAR(z, 1.0 + 0.2 * (now + 0.02 + 0.008 + 0.005), 1e-9)
      << "a sample's time is 5 ms after the motion";
  EXPECT_EQ(display.rows()[1].second, "43 ms, looked ahead by 43 ms");
}

}  // namespace
}  // namespace palpate
