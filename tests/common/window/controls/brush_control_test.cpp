// The brush: what a drag over a slice paints, and when it is no business of its.

#include "common/window/controls/brush_control.h"

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

constexpr InputEvent kPress{.kind = InputKind::kPress}, kMove{.kind = InputKind::kMove},
    kRelease{.kind = InputKind::kRelease};

TEST(BrushControl, LeavesBallsAlongTheWayHalfARadiusApart) {
  BrushControl brush;
  brush.on = true;
  brush.radius = 2.0;
  EXPECT_TRUE(brush.handle(kPress, Vec3(0.0)));
  EXPECT_TRUE(brush.handle(kMove, Vec3(0.5, 0.0, 0.0)));
  EXPECT_TRUE(brush.handle(kMove, Vec3(1.0, 0.0, 0.0)));
  EXPECT_TRUE(brush.handle(kMove, std::nullopt)) << "beside the slices nothing is painted";
  EXPECT_TRUE(brush.take_stroke().empty()) << "not before it ends";
  EXPECT_TRUE(brush.handle(kRelease, std::nullopt));
  EXPECT_EQ(brush.take_stroke(), (std::vector<Vec3>{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}));
  EXPECT_TRUE(brush.take_stroke().empty()) << "once";
}

TEST(BrushControl, LeavesOtherEventsAlone) {
  BrushControl brush;
  EXPECT_FALSE(brush.handle(kPress, Vec3(0.0))) << "it is off";
  brush.on = true;
  EXPECT_FALSE(brush.handle(kPress, std::nullopt)) << "no slice is there";
  EXPECT_FALSE(brush.handle({.kind = InputKind::kPress, .button = MouseButton::kRight}, Vec3(0.0)));
  EXPECT_FALSE(brush.handle(kMove, Vec3(0.0)));
  EXPECT_FALSE(brush.handle(kRelease, Vec3(0.0)));
}

}  // namespace
}  // namespace palpate::test
