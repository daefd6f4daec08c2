// The menu in space of a window, under the mouse: it is where its picture is, chooses commands, and sets what
// its sliders and knob say.

#include "common/window/immersive/menu_control.h"

#include <memory>

#include <gtest/gtest.h>

#include "common/hand/technique/probe_mouse.h"
#include "common/math/quaternion.h"
#include "common/window/controls/scene_controls.h"

namespace palpate {
namespace {

const PictureArea kArea{300.0, 20.0, 640.0, 480.0};

class MenuControlTest : public testing::Test {
 protected:
  MenuControlTest() {
    auto info = std::make_shared<SceneInfo>();
    info->times = {0.0, 0.5, 1.0, 1.5};
    scene_.info = info;
    scene_.lines = std::make_shared<const std::vector<Line>>(std::vector<Line>(1));
    view_.bounds = {Vec3(-1.0), Vec3(1.0)};
    view_.camera = make_camera(view_.bounds, {}, kArea.width / kArea.height);
    menu_.toggle(scene_, view_, {"streamline", "isosurface"});
  }

  /// Moves the mouse to where a place of the menu is drawn.
  void move_to(double u, double v, const Camera& camera) {
    menu_.place(camera, kArea);
    const LabelView label = *menu_.drawn();
    const Vec3 at = label.origin + label.unit * (u * label.axes[0] - v * label.axes[1]);
    const Vec3 shown = project(camera, at, static_cast<int>(kArea.width), static_cast<int>(kArea.height));
    (void)menu_.handle({.kind = InputKind::kMove, .x = kArea.left + shown.x, .y = kArea.top + shown.y}, kArea,
                       camera);
  }
  bool press() { return menu_.handle({.kind = InputKind::kPress}, kArea, view_.camera); }
  bool release() { return menu_.handle({.kind = InputKind::kRelease}, kArea, view_.camera); }
  std::vector<Command> act() { return menu_.act(scene_, document_, view_); }

  SceneState scene_;
  SceneView view_;
  Document document_;
  MenuControl menu_;
};

TEST_F(MenuControlTest, ChoosesCommandsWhereverTheCameraIs) {
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    view_.camera = make_camera(view_.bounds, {.azimuth = 130.0, .elevation = -20.0},
                               kArea.width / kArea.height, projection);
    move_to(1.0, 0.5, view_.camera);  // "Touch" opens its modes
    move_to(8.5, 1.5, view_.camera);
    EXPECT_TRUE(press());
    EXPECT_TRUE(release());
    EXPECT_EQ(act(), std::vector<Command>{Command::kMode2});
    move_to(1.0, 3.5, view_.camera);
    EXPECT_TRUE(press());
    EXPECT_TRUE(release());
    EXPECT_EQ(act(), std::vector<Command>{Command::kUndo});
    EXPECT_TRUE(act().empty()) << "once";
    move_to(30.0, 1.0, view_.camera);
    EXPECT_FALSE(press()) << "beside it the mouse is that of the view";
  }
}

TEST_F(MenuControlTest, SetsStepWidthAndTurn) {
  const double left = 0.6, length = SpaceMenu::kColumn - 1.2;
  move_to(left + length / 3.0, 4.0 + 1.05, view_.camera);  // step 1 of 0 to 3
  EXPECT_TRUE(press());
  EXPECT_TRUE(act().empty());
  EXPECT_EQ(time_step_of(document_, scene_.info->times), 1U);
  EXPECT_TRUE(release());
  move_to(left, 5.5 + 1.05, view_.camera);  // the least width
  EXPECT_TRUE(press());
  EXPECT_TRUE(release());
  (void)act();
  EXPECT_EQ(view_.style.width, 1.0);
  // The knob: a quarter to the right about the viewer's up, in steps of 15 degrees.
  const Camera before = view_.camera;
  const double top = 8.5;
  move_to(1.5 + 0.8, top + 1.5, before);
  EXPECT_TRUE(press());
  for (int degrees = 5; degrees <= 95; degrees += 5)
    move_to(1.5 + 0.8 * std::cos(degrees * kDegree), top + 1.5 + 0.8 * std::sin(degrees * kDegree), before);
  (void)act();
  Camera expected = before;
  for (int i = 0; i < 6; ++i) turn(expected, 15.0 * kDegree, 0.0);
  EXPECT_LT(glm::distance(view_.camera.axes[2], expected.axes[2]), 1e-12);
}

// What turns the view by the menu leaves the menu where it is on the screen, in that very picture.
TEST_F(MenuControlTest, StaysOnTheScreenWhileItTurnsTheView) {
  ProbeSession session({}, [] {});
  SceneControls controls(session, std::nullopt);
  const ControlledScene on{.scene = &scene_, .view = view_, .picture = kArea};
  controls.toggle_menu(on);
  controls.place(on, false);
  const auto corner = [&] {
    SceneView picture = view_;
    controls.decorate(on, picture);
    const LabelView& label = picture.labels.back();
    EXPECT_EQ(label.axes, view_.camera.axes);
    return project(view_.camera, label.origin, static_cast<int>(kArea.width), static_cast<int>(kArea.height));
  };
  const Vec3 before = corner();
  turn(view_.camera, 15.0 * kDegree, 0.0);
  EXPECT_LT(glm::distance(corner(), before), 1e-9);
}

TEST_F(MenuControlTest, IsPointedAtByAStylusAndGoesAway) {
  menu_.place(view_.camera, kArea);
  const LabelView label = *menu_.drawn();
  const Vec3 hand = label.origin + 10.0 * label.unit * label.axes[2];
  const auto ray = [&](double u, double v) {
    return Ray{hand,
               glm::normalize(label.origin + label.unit * (u * label.axes[0] - v * label.axes[1]) - hand)};
  };
  EXPECT_TRUE(menu_.point(ray(1.0, 3.5), false));
  EXPECT_TRUE(menu_.point(ray(1.0, 3.5), true));
  EXPECT_EQ(act(), std::vector<Command>{Command::kUndo});
  EXPECT_FALSE(menu_.point(ray(-3.0, 3.5), false));
  menu_.toggle(scene_, view_, {});
  EXPECT_FALSE(menu_.shown());
  EXPECT_FALSE(menu_.point(ray(1.0, 3.5), true));
}

}  // namespace
}  // namespace palpate
