#include "common/window/controls/plane_image_control.h"

#include <gtest/gtest.h>

#include "tests/common/render/volume/sample_volumes.h"

namespace palpate::test {
namespace {

const PictureArea kArea{100.0, 50.0, 400.0, 200.0};

class PlaneImageControlTest : public ::testing::Test {
 protected:
  PlaneImageControlTest() {
    view_.cuts = {{.kept = {{0.0, 0.0, 1.0}, 0.25}, .on = true}};
    view_.planes.shown = true;
    view_.planes.window = ValueWindow{0.5, 0.4};
    camera_ = make_camera(view_.image->bounds(), {.azimuth = 0.0, .elevation = 60.0}, 2.0);
  }
  bool send(const InputEvent& event) { return control_.handle(event, kArea, camera_, view_); }
  bool move(double x, double y) { return send({.kind = InputKind::kMove, .x = x, .y = y}); }
  bool press() { return send({.kind = InputKind::kPress, .button = MouseButton::kLeft}); }
  void hold_control() { send({.kind = InputKind::kKeyDown, .key = 341}); }
  [[nodiscard]] Vec3 shown(const Vec3& x) const {
    return project(camera_, x, 400, 200) + Vec3(kArea.left, kArea.top, 0.0);
  }

  PlaneImageControl control_;
  VolumeView view_ = sampled_view([](const Vec3& x) { return 1.0 + x.x; });  // values from 0 to 2
  Camera camera_;
};

TEST_F(PlaneImageControlTest, ADragWithControlSetsWindowAndLevel) {
  const Vec3 at = shown({0.2, -0.3, 0.25});
  move(at.x, at.y);
  EXPECT_FALSE(press());  // without Ctrl it is the camera's
  hold_control();
  ASSERT_TRUE(press());
  // A tenth of the picture to the right and upward: of the range, 2.
  EXPECT_TRUE(move(at.x + 40.0, at.y - 20.0));
  EXPECT_NEAR(view_.planes.window->width, 0.7, 1e-12);
  EXPECT_NEAR(view_.planes.window->level, 0.6, 1e-12);
  // Never to nothing.
  move(at.x - 4000.0, at.y);
  EXPECT_GT(view_.planes.window->width, 0.0);
  EXPECT_TRUE(send({.kind = InputKind::kRelease, .button = MouseButton::kLeft}));
  EXPECT_FALSE(move(at.x, at.y));
}

TEST_F(PlaneImageControlTest, PicksThePlaneInFrontWhereItIsSeen) {
  const Vec3 place{0.4, 0.5, 0.25}, at = shown(place);
  const auto found = pick_plane_image(view_, camera_, kArea, at.x, at.y);
  ASSERT_TRUE(found);
  EXPECT_NEAR(glm::distance(*found, place), 0.0, 1e-9);
  const Vec3 beside = shown({1.4, 0.5, 0.25});
  EXPECT_FALSE(pick_plane_image(view_, camera_, kArea, beside.x, beside.y));
  // Another plane cuts this part of it away.
  view_.cuts.push_back({.kept = {{1.0, 0.0, 0.0}, 0.0}, .on = true});
  const auto behind = pick_plane_image(view_, camera_, kArea, at.x, at.y);
  EXPECT_TRUE(!behind || glm::distance(*behind, place) > 0.1);
}

}  // namespace
}  // namespace palpate::test
