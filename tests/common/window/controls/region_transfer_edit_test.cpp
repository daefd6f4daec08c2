#include "common/window/controls/region_transfer_edit.h"

#include <vector>

#include <gtest/gtest.h>

namespace palpate {
namespace {

using Shape = TransferRegion::Shape;

// Values from 0 to 100, gradients from 0 to 10.
const PlaceRange kRange{{0.0, 0.0}, {100.0, 10.0}};

RegionTransfer two() {
  return RegionTransfer(
      {{.shape = Shape::kBox, .corners = {Vec2(10.0, 1.0), Vec2(30.0, 4.0), Vec2(0.0)}},
       {.shape = Shape::kTriangle, .corners = {Vec2(50.0, 0.0), Vec2(40.0, 8.0), Vec2(60.0, 8.0)}}});
}

TEST(RegionTransferEdit, FindsTheNearestCornerAndTheRegionUnderThePointer) {
  EXPECT_EQ(corner_near(two(), {31.0, 4.1}, 0.05, kRange), (RegionCorner{0, 1}));
  EXPECT_EQ(corner_near(two(), {59.0, 7.9}, 0.05, kRange), (RegionCorner{1, 2}));
  EXPECT_FALSE(corner_near(two(), {20.0, 2.5}, 0.05, kRange)) << "a box has two corners that are dragged";
  EXPECT_EQ(region_at(two(), {20.0, 2.5}), 0U);
  EXPECT_EQ(region_at(two(), {50.0, 5.0}), 1U);
  EXPECT_FALSE(region_at(two(), {41.0, 1.0}));
}

TEST(RegionTransferEdit, MovesCornersAndRegionsAndLeavesWhatWouldHaveNoWidth) {
  const RegionTransfer moved = with_corner_at(two(), {1, 0}, {45.0, 2.0});
  EXPECT_EQ(moved.regions()[1].corners[0], Vec2(45.0, 2.0));
  EXPECT_EQ(moved.regions()[0], two().regions()[0]);
  EXPECT_EQ(with_corner_at(two(), {0, 0}, {30.0, 2.0}), two());
  EXPECT_EQ(with_region_moved(two(), 1, {-5.0, 1.0}).regions()[1].corners[2], Vec2(55.0, 9.0));
}

TEST(RegionTransferEdit, AddsTakesOutAndReshapesRegions) {
  const RegionTransfer three = with_region(two(), {80.0, 5.0}, kRange);
  ASSERT_EQ(three.regions().size(), 3U);
  EXPECT_EQ(region_at(three, {80.0, 5.0}), 2U);
  EXPECT_EQ(without_region(three, 2), two());
  const TransferRegion standing = with_shape(two(), 0, Shape::kTriangle).regions()[0];
  EXPECT_EQ(standing.corners[0], Vec2(20.0, 1.0));
  EXPECT_EQ(standing.corners[2], Vec2(30.0, 4.0));
  EXPECT_EQ(with_shape(two(), 1, Shape::kBox).regions()[1].corners[1], Vec2(60.0, 8.0));
  EXPECT_EQ(grown(kRange, with_region_moved(two(), 1, {60.0, 4.0})).upper, Vec2(120.0, 12.0));
  RegionTransfer many;
  for (std::size_t i = 0; i <= kMostRegions; ++i) many = with_region(many, {50.0, 5.0}, kRange);
  EXPECT_EQ(many.regions().size(), kMostRegions);
}

}  // namespace
}  // namespace palpate
