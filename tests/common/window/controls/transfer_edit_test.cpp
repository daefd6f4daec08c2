#include "common/window/controls/transfer_edit.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

ColorTransfer ramp() {
  return ColorTransfer(
      {{10.0, Vec3f(0.0F), 0.0}, {20.0, Vec3f(1.0F, 0.0F, 0.0F), 0.5}, {30.0, Vec3f(1.0F), 1.0}});
}
const ValueSpan kSpan{0.0, 100.0};

TEST(TransferEdit, FindsTheNearestPointWithinReach) {
  EXPECT_EQ(point_near(ramp(), 21.0, 0.5, 0.05, kSpan), 1U);
  EXPECT_EQ(point_near(ramp(), 26.0, 0.9, 0.2, kSpan), 2U);
  EXPECT_FALSE(point_near(ramp(), 60.0, 0.5, 0.05, kSpan));
  EXPECT_FALSE(point_near(ColorTransfer(), 60.0, 0.5, 1.0, kSpan));
}

TEST(TransferEdit, MovesPointsNoFartherThanTheirNeighboursAndOpacities) {
  const ColorTransfer moved = with_point_at(ramp(), 1, 99.0, 7.0, kSpan);
  EXPECT_EQ(moved.points()[1].value, 30.0);
  EXPECT_EQ(moved.points()[1].opacity, 1.0);
  EXPECT_EQ(moved.points()[1].color, ramp().points()[1].color);
  EXPECT_EQ(with_point_at(ramp(), 0, -5.0, -1.0, kSpan).points()[0].value, 0.0);
  EXPECT_EQ(with_point_at(ramp(), 2, 500.0, 0.3, kSpan).points()[2].value, 100.0);
}

TEST(TransferEdit, AddsPointsInTheColourThatIsThereAndKeepsTheLastOne) {
  const ColorTransfer more = with_point(ramp(), 15.0, 0.8, kSpan);
  ASSERT_EQ(more.points().size(), 4U);
  EXPECT_EQ(more.points()[1].value, 15.0);
  EXPECT_EQ(more.points()[1].opacity, 0.8);
  EXPECT_EQ(more.points()[1].color, ramp().at(15.0).color);
  EXPECT_EQ(without_point(more, 1), ramp());
  ColorTransfer one = without_point(without_point(ramp(), 0), 0);
  ASSERT_EQ(one.points().size(), 1U);
  EXPECT_EQ(without_point(one, 0), one);
  EXPECT_EQ(with_point(ColorTransfer(), 5.0, 0.5, kSpan).points().size(), 1U);
}

TEST(TransferEdit, RecoloursAndShowsEveryPoint) {
  EXPECT_EQ(with_color(ramp(), 2, Vec3f(0.0F, 1.0F, 0.0F)).points()[2].color, Vec3f(0.0F, 1.0F, 0.0F));
  const ValueSpan span = grown({15.0, 25.0}, ramp());
  EXPECT_EQ(span.low, 10.0);
  EXPECT_EQ(span.high, 30.0);
  EXPECT_EQ(grown(kSpan, ColorTransfer()).high, 100.0);
}

}  // namespace
}  // namespace palpate
