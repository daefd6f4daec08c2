#include "common/field/transfer/region_transfer.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/transfer/color_transfer.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

using Shape = TransferRegion::Shape;

TransferRegion region(Shape shape, std::array<Vec2, 3> corners) {
  return {.shape = shape, .corners = corners, .color = {1.0F, 0.5F, 0.0F}, .opacity = 0.5, .soft = 0.0};
}

PlaceRange no_range() {
  ADD_FAILURE() << "the range of the data is not asked for";
  return {};
}

// The border is where the place is 1, in each shape; the middle is 0.
TEST(RegionTransfer, MeasuresPlacesFromTheMiddleToTheBorder) {
  const TransferRegion box = region(Shape::kBox, {Vec2(3.0, 10.0), Vec2(1.0, 20.0), {}});
  EXPECT_EQ(box.border_place({2.0, 15.0}), 0.0);
  EXPECT_DOUBLE_EQ(box.border_place({1.0, 15.0}), 1.0);
  EXPECT_DOUBLE_EQ(box.border_place({2.5, 17.5}), 0.5);
  const TransferRegion ellipse = region(Shape::kEllipse, box.corners);
  EXPECT_DOUBLE_EQ(ellipse.border_place({2.5, 17.5}), std::sqrt(0.5));
  const TransferRegion triangle = region(Shape::kTriangle, {Vec2(0.0, 0.0), Vec2(-3.0, 9.0), Vec2(3.0, 9.0)});
  EXPECT_NEAR(triangle.border_place({0.0, 6.0}), 0.0, 1e-12);
  EXPECT_NEAR(triangle.border_place({0.0, 9.0}), 1.0, 1e-12);
  EXPECT_NEAR(triangle.border_place({-1.5, 4.5}), 1.0, 1e-12);
  EXPECT_GT(triangle.border_place({-1.6, 4.5}), 1.0);
}

TEST(RegionTransfer, FallsOffOverItsSoftBorder) {
  TransferRegion box = region(Shape::kBox, {Vec2(0.0), Vec2(2.0), {}});
  box.soft = 0.5;
  const RegionTransfer transfer({box});
  EXPECT_DOUBLE_EQ(transfer.at({1.0, 1.0}).depth, std::log(2.0));
  EXPECT_DOUBLE_EQ(transfer.at({1.5, 1.0}).depth, std::log(2.0));
  EXPECT_DOUBLE_EQ(transfer.at({1.75, 1.0}).depth, -std::log(1.0 - 0.5 * 0.5));
  EXPECT_EQ(transfer.at({2.0, 1.0}).depth, 0.0);
  EXPECT_EQ(transfer.at({std::nan(""), 1.0}).depth, 0.0);
  EXPECT_EQ(RegionTransfer().at({1.0, 1.0}).depth, 0.0);
}

// Two layers of matter let through the product of what each does, in either order.
TEST(RegionTransfer, AddsUpTheMatterOfRegionsThatOverlap) {
  TransferRegion a = region(Shape::kBox, {Vec2(0.0), Vec2(2.0), {}}), b = a;
  b.color = {0.0F, 0.5F, 1.0F};
  b.opacity = 0.75;
  const auto one = RegionTransfer({a, b}).at({1.0, 1.0}), other = RegionTransfer({b, a}).at({1.0, 1.0});
  EXPECT_NEAR(1.0 - std::exp(-one.depth), 1.0 - 0.5 * 0.25, 1e-12);
  EXPECT_NEAR(one.color.r, std::log(2.0) / std::log(8.0), 1e-6);
  EXPECT_NEAR(one.depth, other.depth, 1e-12);
  EXPECT_NEAR(one.color.b, other.color.b, 1e-6);
}

TEST(RegionTransfer, RefusesWhatIsNoRegion) {
  const TransferRegion fine = region(Shape::kBox, {Vec2(0.0), Vec2(2.0), {}});
  const auto refuses = [&](auto change) {
    TransferRegion bad = fine;
    change(bad);
    EXPECT_THROW(RegionTransfer({fine, bad}), Error);
  };
  refuses([](TransferRegion& r) { r.corners[0].x = std::nan(""); });
  refuses([](TransferRegion& r) { r.corners[1].y = HUGE_VAL; });
  refuses([](TransferRegion& r) { r.corners[1].x = 0.0; });
  refuses([](TransferRegion& r) { r.color.g = 1.5F; });
  refuses([](TransferRegion& r) { r.opacity = -0.1; });
  refuses([](TransferRegion& r) { r.soft = 2.0; });
  refuses([](TransferRegion& r) {
    r.shape = Shape::kTriangle;
    r.corners = {Vec2(0.0), Vec2(1.0), Vec2(2.0)};
  });
  EXPECT_THROW(RegionTransfer(std::vector<TransferRegion>(kMostRegions + 1, fine)), Error);
}

// Shapes do not depend on the units of values and of lengths.
TEST(RegionTransfer, IsTheSameAtAnyPowerOfTwo) {
  const TransferRegion small = region(Shape::kTriangle, {Vec2(0.1, 0.2), Vec2(0.7, 0.3), Vec2(0.4, 0.9)});
  TransferRegion large = small;
  const Vec2 unit(std::ldexp(1.0, 300), std::ldexp(1.0, -300));
  for (Vec2& corner : large.corners) corner *= unit;
  for (const Vec2& place : {Vec2(0.4, 0.5), Vec2(0.3, 0.3), Vec2(0.9, 0.1)})
    EXPECT_EQ(RegionTransfer({large}).at(unit * place).depth, RegionTransfer({small}).at(place).depth);
}

RegionTransfer one_of_each() {
  TransferRegion box = region(Shape::kBox, {Vec2(0.1, 0.2), Vec2(1.0 / 3.0, 0.5), Vec2(0.0)});
  TransferRegion ellipse = region(Shape::kEllipse, box.corners);
  ellipse.soft = 0.3;
  return RegionTransfer(
      {box, ellipse, region(Shape::kTriangle, {Vec2(0.0), Vec2(-3.0, 9e10), Vec2(3.0, 9.0)})});
}

TEST(RegionTransferFile, WordsAndFilesGiveTheSameFunctionBack) {
  EXPECT_EQ(regions_from_text(region_text(one_of_each()), no_range), one_of_each());
  EXPECT_EQ(regions_from_text("points:1,2,3,4,5", no_range), std::nullopt);
  const test::TempFolder folder;
  const std::string file = (folder.path() / "regions.txt").string();
  std::ofstream(file) << regions_text(one_of_each());
  EXPECT_TRUE(is_region_file(file));
  EXPECT_EQ(read_regions(file, no_range), one_of_each());
  std::ofstream(file) << "value,red,green,blue,opacity\n1,0,0,0,0\n";
  EXPECT_FALSE(is_region_file(file));
  EXPECT_FALSE(is_region_file(file + ".none"));
}

TEST(RegionTransferFile, TakesFractionsOfTheRangesOfTheData) {
  const auto range = [] { return PlaceRange{{100.0, 0.0}, {300.0, 50.0}}; };
  const auto transfer = regions_from_text("regions:fractions/box,0.5,0,1,1,1,1,1,0.5,0", range);
  ASSERT_TRUE(transfer.has_value());
  EXPECT_EQ(transfer->regions()[0].corners[0], Vec2(200.0, 0.0));
  EXPECT_EQ(transfer->regions()[0].corners[1], Vec2(300.0, 50.0));
  const test::TempFolder folder;
  const std::string file = (folder.path() / "regions.txt").string();
  std::ofstream(file) << "# by parts\n\nfractions\n ellipse, 0.5,0,1,1, 1,1,1,0.5,0\r\n";
  EXPECT_TRUE(is_region_file(file));
  EXPECT_EQ(read_regions(file, range).regions()[0].corners, transfer->regions()[0].corners);
}

TEST(RegionTransferFile, NamesTheLineThatIsNoRegion) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "regions.txt").string();
  const auto message = [&](const std::string& text) {
    std::ofstream(file) << text;
    try {
      (void)read_regions(file, no_range);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      return std::string(error.what());
    }
    return std::string("none");
  };
  const std::string good = "box,0,0,1,1,1,1,1,0.5,0\n";
  EXPECT_NE(message(good + "ball,0,0,1,1,1,1,1,0.5,0\n").find("2"), std::string::npos);
  EXPECT_NE(message("box,0,0,1,1,1,1,1,0.5\n").find("8 numbers, not 9"), std::string::npos);
  EXPECT_NE(message("box,0,0,1,nan,1,1,1,0.5,0\n").find("finite"), std::string::npos);
  EXPECT_NE(message("box,0,0,1,1,1,2,1,0.5,0\n").find("colour"), std::string::npos);
  EXPECT_NE(message("box,0,0,0,1,1,1,1,0.5,0\n").find("width"), std::string::npos);
  EXPECT_NE(message("# nothing\n").find("no region"), std::string::npos);
  EXPECT_THROW((void)regions_from_text("regions:box,1,2", no_range), Error);
  EXPECT_THROW((void)regions_from_text("regions:/", no_range), Error);
}

TEST(RegionTransfer, BoundariesAreSeenWhereValuesChangeAlone) {
  const RegionTransfer preset = boundary_regions();
  EXPECT_EQ(preset.at({0.5, 0.0}).depth, 0.0);
  EXPECT_GT(preset.at({0.5, 0.6}).depth, 0.05);
  EXPECT_LE(preset.extent().upper.y, 1.0);
}

}  // namespace
}  // namespace palpate
