// What the mouse does in panes of slices.

#include "common/window/controls/pane_control.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/panes_about.h"

namespace palpate {
namespace {

class PaneControlTest : public testing::Test {
 protected:
  PaneControlTest() {
    auto image = std::make_shared<VolumeImage>();
    image->points = {41, 61, 31};
    image->origin = {-20.0, -60.0, 10.0};
    image->axes = Mat3{1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 1.5};
    auto numbers = std::make_shared<std::vector<float>>();
    for (int k = 0; k < 31; ++k)
      for (int j = 0; j < 61; ++j)
        for (int i = 0; i < 41; ++i) numbers->push_back(static_cast<float>(i + 100 * j + 10000 * k));
    image->bytes = std::as_bytes(std::span<const float>(*numbers));
    image->owner = numbers;
    image->lowest = 0.0;
    image->highest = 306040.0;
    scene_.bounds = image->bounds();
    scene_.anatomical = true;
    scene_.volume.emplace().image = image;
    panes() = test::panes_about(scene_.bounds);
    panes().layout = 4;
  }

  SlicePanes& panes() { return scene_.volume->panes; }
  [[nodiscard]] std::vector<Pane> parts() const {
    return panes_of(scene_.volume->panes, static_cast<int>(area_.width), static_cast<int>(area_.height));
  }
  [[nodiscard]] Pane pane(SlicePlane plane) const {
    for (const Pane& one : parts())
      if (one.plane == plane) return one;
    return {};
  }
  /// The pixel of the window that shows a place in a pane.
  [[nodiscard]] Vec2 pixel_of(SlicePlane plane, const Vec3& x) const {
    const Pane in = pane(plane);
    const Vec3 at =
        project(pane_view(scene_, scene_.volume->panes, parts(), in).camera, x, in.width, in.height);
    return {area_.left + in.left + at.x, area_.top + in.top + at.y};
  }
  bool move(const Vec2& to) { return send({.kind = InputKind::kMove, .x = to.x, .y = to.y}); }
  bool press(MouseButton button) { return send({.kind = InputKind::kPress, .button = button}); }
  bool release(MouseButton button) { return send({.kind = InputKind::kRelease, .button = button}); }
  bool wheel(double notches) { return send({.kind = InputKind::kWheel, .y = notches}); }
  void key(int key, bool down) {
    (void)send({.kind = down ? InputKind::kKeyDown : InputKind::kKeyUp, .key = key});
  }
  bool send(const InputEvent& event) {
    control_.follow(event, area_, &*scene_.volume);
    return control_.handle(event, area_, scene_, *scene_.volume);
  }

  static constexpr int kShift = 340, kControl = 341;
  PictureArea area_{300.0, 20.0, 900.0, 700.0};
  SceneView scene_;
  PaneControl control_;
};

TEST_F(PaneControlTest, AClickPutsTheCrosshairUnderTheMouse) {
  const Vec3 wanted = panes().cross + Vec3(7.0, -13.0, 0.0);
  move(pixel_of(SlicePlane::kAxial, wanted));
  EXPECT_TRUE(press(MouseButton::kLeft));
  EXPECT_LT(glm::distance(panes().cross, wanted), 1e-6);
  // A drag goes on, and ends at the border of the volume.
  const Vec3 next = wanted + Vec3(-3.0, 4.0, 0.0);
  EXPECT_TRUE(move(pixel_of(SlicePlane::kAxial, next)));
  EXPECT_LT(glm::distance(panes().cross, next), 1e-6);
  move({area_.left - 5000.0, area_.top});
  EXPECT_GE(panes().cross.x, scene_.bounds.lower.x);
  EXPECT_LE(panes().cross.x, scene_.bounds.upper.x);
  release(MouseButton::kLeft);
  EXPECT_FALSE(control_.dragging());
}

TEST_F(PaneControlTest, TheVolumesOwnPaneIsLeftToOthers) {
  for (const Pane& one : parts()) {
    if (one.plane) continue;
    move({area_.left + one.left + 0.5 * one.width, area_.top + one.top + 0.5 * one.height});
    EXPECT_FALSE(press(MouseButton::kLeft));
    EXPECT_FALSE(wheel(1.0));
  }
  panes().layout = 1;
  move({area_.left + 10.0, area_.top + 10.0});
  EXPECT_FALSE(press(MouseButton::kLeft));
}

/// One notch, one key: one voxel along the plane's normal.
TEST_F(PaneControlTest, WheelAndKeysGoVoxelByVoxel) {
  const Vec3 before = panes().cross;
  move(pixel_of(SlicePlane::kCoronal, before));
  EXPECT_TRUE(wheel(1.0));
  // Radiological: seen from the front, away from the viewer is to the back.
  EXPECT_LT(glm::distance(panes().cross, before - Vec3(0.0, 2.0, 0.0)), 1e-9);
  EXPECT_TRUE(wheel(-1.0));
  EXPECT_LT(glm::distance(panes().cross, before), 1e-9);
  EXPECT_TRUE(PaneControl::run(Command::kSliceUp, *scene_.volume));
  EXPECT_LT(glm::distance(panes().cross, before + Vec3(0.0, 0.0, 1.5)), 1e-9);
  for (int i = 0; i < 100; ++i) (void)PaneControl::run(Command::kSliceLeft, *scene_.volume);
  EXPECT_EQ(panes().cross.x, scene_.bounds.lower.x);
  panes().layout = 1;
  EXPECT_FALSE(PaneControl::run(Command::kSliceUp, *scene_.volume));
}

TEST_F(PaneControlTest, WithControlTheWheelEnlargesAboutTheMouse) {
  const Vec3 there = panes().cross + Vec3(5.0, 20.0, 0.0);
  const Vec2 mouse = pixel_of(SlicePlane::kAxial, there);
  move(mouse);
  key(kControl, true);
  EXPECT_TRUE(wheel(4.0));
  EXPECT_NEAR(panes().zoom, std::pow(1.15, 4.0), 1e-12);
  const Vec2 now = pixel_of(SlicePlane::kAxial, there);
  EXPECT_NEAR(now.x, mouse.x, 1e-6);
  EXPECT_NEAR(now.y, mouse.y, 1e-6);
  for (int i = 0; i < 1000; ++i) (void)wheel(-5.0);
  EXPECT_GT(panes().zoom, 0.0);
}

TEST_F(PaneControlTest, AMiddleDragMovesTheSlices) {
  const Vec3 there = panes().cross;
  const Vec2 from = pixel_of(SlicePlane::kSagittal, there);
  move(from);
  EXPECT_TRUE(press(MouseButton::kMiddle));
  move({from.x + 30.0, from.y - 12.0});
  release(MouseButton::kMiddle);
  const Vec2 now = pixel_of(SlicePlane::kSagittal, there);
  EXPECT_NEAR(now.x, from.x + 30.0, 1e-6);
  EXPECT_NEAR(now.y, from.y - 12.0, 1e-6);
  EXPECT_EQ(panes().cross, there);
}

/// With Shift the other two planes turn about the crosshair as the mouse does; this one stays.
TEST_F(PaneControlTest, WithShiftTheOtherPlanesTurn) {
  key(kShift, true);
  const Vec3 cross = panes().cross;
  move(pixel_of(SlicePlane::kAxial, cross + Vec3(10.0, 0.0, 0.0)));
  EXPECT_TRUE(press(MouseButton::kLeft));
  constexpr double kAngle = 0.4;
  for (int i = 1; i <= 8; ++i)
    move(pixel_of(SlicePlane::kAxial,
                  cross + 10.0 * Vec3(std::cos(kAngle * i / 8), std::sin(kAngle * i / 8), 0.0)));
  release(MouseButton::kLeft);
  EXPECT_LT(glm::distance(normal_of(panes(), SlicePlane::kAxial), Vec3(0.0, 0.0, 1.0)), 1e-12);
  EXPECT_LT(
      glm::distance(normal_of(panes(), SlicePlane::kSagittal), Vec3(std::cos(kAngle), std::sin(kAngle), 0.0)),
      1e-6);
  EXPECT_EQ(panes().cross, cross);
  EXPECT_NEAR(glm::length(panes().turn), 1.0, 1e-12);
}

TEST_F(PaneControlTest, ARightDragSetsWindowAndLevel) {
  scene_.volume->planes.window = ValueWindow{1000.0, 5000.0};
  move(pixel_of(SlicePlane::kAxial, panes().cross));
  EXPECT_TRUE(press(MouseButton::kRight));
  const Vec2 from = pixel_of(SlicePlane::kAxial, panes().cross);
  move({from.x + 90.0, from.y - 70.0});
  const double range = scene_.volume->image->highest;
  EXPECT_NEAR(scene_.volume->planes.window->width, 1000.0 + 0.1 * range, 1e-6 * range);
  EXPECT_NEAR(scene_.volume->planes.window->level, 5000.0 + 0.1 * range, 1e-6 * range);
  move({from.x - 9000.0, from.y});
  EXPECT_GT(scene_.volume->planes.window->width, 0.0);
}

/// A layout without its pane, a lost release: a drag ends with its button, and the next press begins anew.
TEST_F(PaneControlTest, ADragEndsWhateverHappensToItsPane) {
  const Vec3 cross = panes().cross;
  move(pixel_of(SlicePlane::kAxial, cross));
  EXPECT_TRUE(press(MouseButton::kLeft));
  panes().layout = 1;
  move({area_.left + 5.0, area_.top + 5.0});
  release(MouseButton::kLeft);
  EXPECT_FALSE(control_.dragging());
  panes().layout = 4;
  EXPECT_FALSE(move(pixel_of(SlicePlane::kAxial, cross + Vec3(3.0, 0.0, 0.0))));
  EXPECT_EQ(panes().cross, cross);
  // The release is lost to a question, and the mouse goes to another pane.
  EXPECT_TRUE(press(MouseButton::kLeft));
  control_.let_go();
  move(pixel_of(SlicePlane::kSagittal, panes().cross));
  ASSERT_TRUE(control_.sight(area_, scene_));
  EXPECT_EQ(control_.sight(area_, scene_)->area.left, area_.left + pane(SlicePlane::kSagittal).left);
}

/// Touch pads turn the wheel by parts of a notch.
TEST_F(PaneControlTest, PartsOfNotchesAddUp) {
  const Vec3 before = panes().cross;
  move(pixel_of(SlicePlane::kAxial, before));
  for (int i = 0; i < 9; ++i) (void)wheel(0.125);
  EXPECT_NEAR(glm::distance(panes().cross, before), 1.5, 1e-9) << "one voxel";
}

/// Place, voxel and value under the mouse.
TEST_F(PaneControlTest, SaysWhatIsUnderTheMouse) {
  const VolumeImage& image = *scene_.volume->image;
  const Vec3 there = image.origin + image.axes * Vec3(12.0, 34.0, 15.0);
  panes().cross.z = there.z;
  move(pixel_of(SlicePlane::kAxial, there));
  const std::string words = control_.words_under_mouse(area_, parts(), scene_);
  EXPECT_NE(words.find("voxel 12, 34, 15"), std::string::npos) << words;
  EXPECT_NE(words.find(" mm"), std::string::npos) << words;
  EXPECT_NE(words.find(": 153412"), std::string::npos) << words;
  move({area_.left + 1.0, area_.top + 1.0});
  EXPECT_NE(control_.words_under_mouse(area_, parts(), scene_).find("outside"), std::string::npos);
}

}  // namespace
}  // namespace palpate
