// The mouse over a picture for two eyes: each half is a picture of its own, seen by its own eye.

#include "common/window/controls/pointer.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

const PictureArea kPicture{100.0, 50.0, 401.0, 300.0};

StereoView mode(StereoMode mode, bool swapped = false) { return {.mode = mode, .swapped = swapped}; }

TEST(EyeArea, IsTheHalfUnderTheMouse) {
  const EyeArea left = eye_area(mode(StereoMode::kSideBySide), kPicture, 299.9, 60.0);
  EXPECT_EQ(left.eye, 0U);
  EXPECT_EQ(left.area.left, 100.0);
  EXPECT_EQ(left.area.width, 200.0);
  const EyeArea right = eye_area(mode(StereoMode::kSideBySide), kPicture, 300.0, 60.0);
  EXPECT_EQ(right.eye, 1U);
  EXPECT_EQ(right.area.left, 300.0);
  EXPECT_EQ(right.area.height, 300.0);
  EXPECT_EQ(eye_area(mode(StereoMode::kSideBySide, true), kPicture, 300.0, 60.0).eye, 0U);
  const EyeArea below = eye_area(mode(StereoMode::kTopBottom), kPicture, 120.0, 200.0);
  EXPECT_EQ(below.eye, 1U);
  EXPECT_EQ(below.area.top, 200.0);
  EXPECT_EQ(below.area.width, 401.0);
  for (const StereoMode all :
       {StereoMode::kNone, StereoMode::kRows, StereoMode::kAnaglyph, StereoMode::kQuadBuffer}) {
    const EyeArea both = eye_area(mode(all), kPicture, 300.0, 60.0);
    EXPECT_FALSE(both.eye.has_value());
    EXPECT_EQ(both.area.width, 401.0);
    EXPECT_FALSE(in_other_half(mode(all), kPicture, 300.0, 60.0).has_value());
  }
  EXPECT_EQ(in_other_half(mode(StereoMode::kSideBySide), kPicture, 310.0, 60.0), Vec2(110.0, 60.0));
  EXPECT_EQ(in_other_half(mode(StereoMode::kTopBottom), kPicture, 310.0, 60.0), Vec2(310.0, 210.0));
  EXPECT_FALSE(in_other_half(mode(StereoMode::kTopBottom), kPicture, 90.0, 60.0).has_value());
}

TEST(Pointer, StaysInItsHalfWhileAButtonIsDown) {
  Pointer pointer;
  pointer.over(mode(StereoMode::kSideBySide), kPicture);
  pointer.follow({.kind = InputKind::kMove, .x = 350.0, .y = 60.0});
  EXPECT_EQ(pointer.eye(), 1U);
  pointer.follow({.kind = InputKind::kPress});
  pointer.follow({.kind = InputKind::kMove, .x = 150.0, .y = 60.0});
  EXPECT_EQ(pointer.eye(), 1U) << "a drag";
  EXPECT_EQ(pointer.area().left, 300.0);
  pointer.follow({.kind = InputKind::kRelease});
  pointer.follow({.kind = InputKind::kMove, .x = 151.0, .y = 60.0});
  EXPECT_EQ(pointer.eye(), 0U);
  ASSERT_TRUE(pointer.twin().has_value());
  EXPECT_EQ(*pointer.twin(), Vec2(351.0, 60.0));
}

TEST(Aim, LooksWithTheEyeThatSeesAndGivesTheCameraBack) {
  SceneView view;
  view.bounds = {Vec3(-1.0), Vec3(1.0)};
  view.camera = make_camera(view.bounds, {}, 1.0);
  view.stereo = mode(StereoMode::kSideBySide);
  const Camera before = view.camera;
  const auto eyes = stereo_eyes(view.camera, view.stereo, view.bounds).cameras;
  {
    const Aim aim(view.camera, seeing_camera(view, 1));
    EXPECT_EQ(view.camera, eyes[1]);
    turn(view.camera, 0.3, 0.1);  // what the mouse does meanwhile stays
  }
  EXPECT_EQ(view.camera.eye_offset, before.eye_offset);
  EXPECT_EQ(view.camera.field_of_view, before.field_of_view);
  EXPECT_NE(view.camera.axes, before.axes);
}

}  // namespace
}  // namespace palpate
