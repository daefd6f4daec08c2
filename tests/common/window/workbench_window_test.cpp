// A workbench in real windows: screens that show what a head before them sees, a mouse in the halves of a
// picture for two eyes, a latency that is measured.

#include <cmath>
#include <memory>
#include <string>

#include "common/base/error.h"
#include "common/render/render_image.h"
#include "common/window/controls/pointer.h"
#include "common/window/immersive/menu_control.h"
#include "tests/common/render/sample_scenes.h"
#include "tests/common/window/touch_window.h"

namespace palpate::test {
namespace {

/// A head that comes nearer.
std::shared_ptr<PoseSource> coming_head() {
  std::vector<PoseSample> poses;
  for (int i = 0; i < 200; ++i) poses.push_back({0.01 * i, TrackerPose{{0.05, 0.02, 0.7 - 1e-3 * i}, {}}});
  return std::make_shared<ReplayPoses>(std::move(poses));
}

WorkbenchDisplayOptions corner_of_two(std::shared_ptr<PoseSource> head) {
  WorkbenchDisplayOptions options{.head = std::move(head)};
  options.workbench.screens.push_back({.corners = {{-0.2, -0.15, 0.0}, {0.2, -0.15, 0.0}, {-0.2, 0.15, 0.0}},
                                       .name = "front",
                                       .pixels = {160, 120}});
  options.workbench.screens.push_back({.corners = {{0.2, -0.15, 0.0}, {0.2, -0.15, 0.3}, {0.2, 0.15, 0.0}},
                                       .name = "side",
                                       .pixels = {120, 120},
                                       .position = {200, 0},
                                       .stereo = StereoMode::kRows});
  return options;
}

class WorkbenchWindow : public TouchWindowTest {};

TEST_F(WorkbenchWindow, ShowsEveryScreenFromTheHead) {
  options_.touch.modes.clear();
  const TrackerPose head{{-0.05, 0.03, 0.6}, {}};
  options_.workbench = corner_of_two(std::make_shared<RestingPose>(head));
  options_.workbench->several = true;
  options_.hidden = true;
  const WindowResult result = run();
  ASSERT_EQ(result.screens.size(), 2U);
  WorkbenchDisplay workbench(corner_of_two(std::make_shared<RestingPose>(head)));
  workbench.follow(1.0);
  for (std::size_t i = 0; i < 2; ++i) {
    const ScreenGeometry& screen = workbench.options().workbench.screens[i];
    SceneView seen = result.view;
    seen.stereo.mode = screen.stereo;
    workbench.show(screen.corners, seen);
    const Image expected = render_image(seen, screen.pixels[0], screen.pixels[1]).image;
    ASSERT_EQ(result.screens[i].width, expected.width);
    EXPECT_TRUE(result.screens[i].rgba == expected.rgba) << screen.name;
    cache_picture(result.screens[i], "workbench_" + screen.name);
  }
  EXPECT_EQ(result.view.camera.eye_offset, Vec2(0.0)) << "the desktop is one more display";
  EXPECT_LT(glm::distance(result.view.camera.axes[2], Vec3(0.0, 0.0, 1.0)), 1e-12)
      << "as the front screen lies";
}

TEST_F(WorkbenchWindow, MeasuresTheLatencyOfItsPictures) {
  options_.touch.modes.clear();
  options_.workbench = corner_of_two(coming_head());
  options_.workbench->workbench.screens[0].pixels = {0, 0};
  options_.workbench->workbench.head.sensor_latency = 0.01;
  const WindowResult result = run();
  EXPECT_GT(result.latency, 0.01);
  EXPECT_LT(result.latency, 5.0);
}

// In the right half the right eye's picture is seen: a probe that is grabbed on a line there is on that line.
TEST_F(WorkbenchWindow, GrabsWhatIsSeenInTheHalfOfAnEye) {
  options_.view.stereo = {.mode = StereoMode::kSideBySide, .separation = 0.2, .most_disparity = 1.0};
  options_.view.show_color_bar = false;
  const WindowResult idle = run();
  const PictureArea picture = layout(options_.width, options_.height, 14.0F).picture;
  const EyeArea right =
      eye_area(options_.view.stereo, picture, picture.left + picture.width - 1.0, picture.top);
  const Camera eye = stereo_eyes(idle.view.camera, options_.view.stereo, idle.view.bounds).cameras[1];
  // A place on a line that is clearly before the screen, and alone in the picture.
  const auto size = PictureSize{static_cast<int>(right.area.width), static_cast<int>(right.area.height)};
  Vec3 place{0.0};
  double nearest = HUGE_VAL;
  for (const LinePoint& point : idle.view.lines->back().points) {
    const Vec3 shown = project(eye, point.position, size.width, size.height);
    if (shown.x < 20.0 || shown.x > size.width - 20.0 || shown.y < 20.0 || shown.y > size.height - 20.0)
      continue;
    if (shown.z < nearest) {
      nearest = shown.z;
      place = point.position;
    }
  }
  ASSERT_LT(nearest, 0.95 * distance(eye)) << "before the screen";
  const Vec3 shown = project(eye, place, size.width, size.height);
  options_.script.clear();
  last_ = 0;
  move(2, right.area.left + shown.x, right.area.top + shown.y);
  key_down(4, 'G');
  const WindowResult result = run();
  ASSERT_TRUE(result.probe.held);
  EXPECT_LT(glm::distance(result.probe.probe, place), 0.02 * idle.view.bounds.diagonal());
}

// The menu in space, under the mouse where it is drawn.
TEST_F(WorkbenchWindow, ShowsAMenuThatTheMouseWorks) {
  const WindowResult idle = run();
  ASSERT_TRUE(idle.view.show_axes);
  Progress progress;
  HelixModel again;
  MenuControl menu;
  std::vector<std::string> modes;
  for (const HapticMode& mode : options_.touch.modes) modes.push_back(mode.name);
  menu.toggle(again.start(progress), idle.view, modes);
  const PictureArea picture = layout(options_.width, options_.height, 14.0F).picture;
  menu.place(idle.view.camera, picture);
  const LabelView sign = *menu.drawn();
  const auto move_to = [&](int frame, double u, double v) {
    const Vec3 at = sign.origin + sign.unit * (u * sign.axes[0] - v * sign.axes[1]);
    const Vec3 shown =
        project(idle.view.camera, at, static_cast<int>(picture.width), static_cast<int>(picture.height));
    move(frame, picture.left + shown.x, picture.top + shown.y);
  };
  options_.script.clear();
  last_ = 0;
  key_down(2, 'M');
  move_to(4, 1.0, 2.5);                       // "Show" opens
  move_to(6, SpaceMenu::kColumn + 1.5, 2.5);  // "axes"
  at(8, {.kind = InputKind::kPress});
  at(9, {.kind = InputKind::kRelease});
  move_to(11, 1.0, 5.0);  // on to the sliders
  const WindowResult result = run();
  EXPECT_FALSE(result.view.show_axes);
  EXPECT_EQ(result.view.camera, idle.view.camera) << "the mouse was the menu's";
}

// Two buffers where the display has such, else one line that says what to do.
TEST_F(WorkbenchWindow, OpensForTwoBuffersOrSaysWhyNot) {
  options_.touch.modes.clear();
  options_.view.stereo.mode = StereoMode::kQuadBuffer;
  options_.screenshot.clear();
  try {
    EXPECT_GT(run().frames, 0);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kWorkFailed);
    EXPECT_NE(std::string(error.what()).find("try --stereo rows"), std::string::npos) << error.what();
  }
  options_.view.stereo.mode = StereoMode::kNone;
  EXPECT_GT(run().frames, 0) << "the next window has one";
}

}  // namespace
}  // namespace palpate::test
