// Picking tracts by the mouse: which ray a press stands for, and when it is no business of the control.

#include "common/window/controls/tract_pick_control.h"

#include <gtest/gtest.h>

#include "common/render/camera.h"

namespace palpate::test {
namespace {

constexpr PictureArea kArea{.left = 100.0, .top = 50.0, .width = 800.0, .height = 600.0};

double distance_of(const PickBeam& beam, const Vec3& x) {
  return glm::length(glm::cross(x - beam.origin, beam.direction));
}

TEST(TractPickControl, PointsAtWhatIsDrawnUnderTheMouse) {
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    Box box;
    box.include(Vec3(-50.0, -60.0, -40.0));
    box.include(Vec3(70.0, 60.0, 50.0));
    const Camera camera = make_camera(box, {.azimuth = 40.0, .elevation = 25.0}, 4.0 / 3.0, projection);
    const Vec3 place(20.0, -30.0, 10.0);  // before the focal plane
    const Vec3 drawn = project(camera, place, 800, 600);
    TractPickControl control;
    control.on = true;
    ASSERT_TRUE(control.handle(
        {.kind = InputKind::kPress, .x = kArea.left + drawn.x, .y = kArea.top + drawn.y}, kArea, camera, {}));
    const auto pick = control.take();
    ASSERT_TRUE(pick);
    EXPECT_LT(distance_of(pick->beam, place), 1e-6 * camera.view_height);
    EXPECT_NEAR(glm::length(pick->beam.direction), 1.0, 1e-12);
    const double depth = glm::dot(camera.focal_point - pick->beam.origin, pick->beam.direction);
    EXPECT_NEAR(pick->beam.radius + pick->beam.spread * depth, 8.0 * camera.view_height / 600.0,
                0.05 * camera.view_height / 600.0)
        << "eight pixels";
    EXPECT_FALSE(control.take()) << "once";
  }
}

TEST(TractPickControl, LeavesOtherEventsAlone) {
  const Camera camera;
  TractPickControl control;
  const InputEvent press{.kind = InputKind::kPress, .x = 300.0, .y = 300.0};
  EXPECT_FALSE(control.handle(press, kArea, camera, {})) << "it is off";
  control.on = true;
  EXPECT_FALSE(control.handle({.kind = InputKind::kPress, .x = 10.0, .y = 300.0}, kArea, camera, {}))
      << "beside the picture";
  EXPECT_FALSE(control.handle(
      {.kind = InputKind::kPress, .x = 300.0, .y = 300.0, .button = MouseButton::kRight}, kArea, camera, {}));
  EXPECT_FALSE(control.handle({.kind = InputKind::kMove, .x = 300.0, .y = 300.0}, kArea, camera, {}));
  EXPECT_FALSE(control.take());
  EXPECT_TRUE(control.handle(press, kArea, camera, Vec3(1.0, 2.0, 3.0)));
  EXPECT_TRUE(control.handle({.kind = InputKind::kMove, .x = 310.0, .y = 300.0}, kArea, camera, {}))
      << "the drag of a press is nobody else's";
  EXPECT_TRUE(control.handle({.kind = InputKind::kRelease, .x = 310.0, .y = 300.0}, kArea, camera, {}));
  EXPECT_EQ(control.take()->place, Vec3(1.0, 2.0, 3.0));
}

}  // namespace
}  // namespace palpate::test
