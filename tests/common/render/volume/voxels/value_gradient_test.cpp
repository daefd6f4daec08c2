#include "common/render/volume/voxels/value_gradient.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "common/render/volume/voxels/brick_map.h"
#include "common/render/volume/voxels/region_table.h"
#include "tests/common/render/volume/sample_volumes.h"

namespace palpate::test {
namespace {

std::shared_ptr<const VolumeImage> image_of(const DataSet& block) {
  return make_volume_image(block, "s", "test");
}

// v = 3 x - 2 y + z / 2 on sheared axes: away from the border, where differences are halved, the gradient is
// the same everywhere, whatever the axes.
TEST(ValueGradient, OfALinearCourseIsExactOnShearedAxes) {
  constexpr int kSide = 26;
  UniformTopology grid;
  grid.points = Index3(kSide);
  grid.axes = Mat3(Vec3(0.8, 0.6, 0.0), Vec3(0.55, -0.8, 0.1), Vec3(0.2, 0.1, 0.9));
  std::vector<float> values;
  for (int i = 0; i < kSide * kSide * kSide; ++i) {
    const Vec3 g(i % kSide, i / kSide % kSide, i / (kSide * kSide));
    values.push_back(static_cast<float>(glm::dot(Vec3(3.0, -2.0, 0.5), grid.axes * g)));
  }
  DataSet block = block_of(grid.points, Vec3(1.0), std::move(values), ScalarType::kFloat32);
  block.topology = grid;
  const GradientRanges ranges = gradient_ranges(*image_of(block), Index3(4));
  const GradientRanges::Range& inner = ranges.ranges[1 + 4 + 16];
  constexpr double kRounding = 2e-5;  // of single precision
  EXPECT_NEAR(inner.highest, glm::length(Vec3(3.0, -2.0, 0.5)), kRounding);
  EXPECT_NEAR(inner.lowest, inner.highest, kRounding);
}

TEST(ValueGradient, OfVoxelsOfBytesIsThatOfTheirValues) {
  DataSet block =
      block_of({9, 2, 2}, Vec3(0.25, 1.0, 1.0), std::vector<std::int16_t>(36), ScalarType::kInt16);
  std::vector<std::int16_t> ramp;
  for (int i = 0; i < 36; ++i) ramp.push_back(static_cast<std::int16_t>(-100 + 5 * (i % 9)));
  block = block_of({9, 2, 2}, Vec3(0.25, 1.0, 1.0), ramp, ScalarType::kInt16);
  EXPECT_DOUBLE_EQ(highest_gradient(*image_of(block)), 20.0);
}

// At any place of a brick the magnitude lies in its range: 200 places a brick, interpolated.
TEST(ValueGradient, RangesOfBricksHoldEveryPlaceBetweenTheirPoints) {
  const auto image =
      image_of(sampled_block({19, 17, 21}, Vec3(0.1, 0.2, 0.05), ScalarType::kFloat32, shells));
  const BrickRanges bricks = brick_ranges(*image);
  const GradientRanges ranges = gradient_ranges(*image, bricks.bricks);
  const Index3 n = image->points;
  const auto number = [&](Vec3 g) {
    g = glm::clamp(g, Vec3(0.0), Vec3(n - 1));
    const Index3 cell = glm::min(Index3(glm::floor(g)), n - 2);
    const Vec3 u = g - Vec3(cell);
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const Index3 bit{corner & 1, corner >> 1 & 1, corner >> 2 & 1}, p = cell + bit;
      const Vec3 weight = glm::mix(1.0 - u, u, Vec3(bit));
      sum += weight.x * weight.y * weight.z *
             image->number(static_cast<std::size_t>(p.x + n.x * (p.y + n.y * p.z)));
    }
    return sum;
  };
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  constexpr double kRounding = 1e-6;
  double widest = 0.0;
  for (int z = 0; z < bricks.bricks.z; ++z) {
    for (int y = 0; y < bricks.bricks.y; ++y) {
      for (int x = 0; x < bricks.bricks.x; ++x) {
        const auto& range =
            ranges.ranges[static_cast<std::size_t>(x + bricks.bricks.x * (y + bricks.bricks.y * z))];
        for (int i = 0; i < 200; ++i) {
          const Vec3 first(kBrickCells * Index3(x, y, z));
          const Vec3 g = first + Vec3(part(random), part(random), part(random)) *
                                     glm::min(Vec3(kBrickCells), Vec3(n - 1) - first);
          Vec3 slope(0.0);
          for (int a = 0; a < 3; ++a) {
            Vec3 side(0.0);
            side[a] = 1.0;
            slope[a] = 0.5 * (number(g + side) - number(g - side)) / image->axes[a][a];
          }
          const double size = glm::length(slope);
          ASSERT_GE(size, range.lowest - kRounding);
          ASSERT_LE(size, range.highest + kRounding);
          widest = std::max(widest, size);
        }
      }
    }
  }
  EXPECT_GT(widest, 0.5 * highest_gradient(*image));
}

TEST(ValueGradient, HistogramCountsEveryPointOnceOnAnyNumberOfThreads) {
  const auto image = image_of(sampled_block({23, 17, 11}, Vec3(0.1), ScalarType::kFloat32, blobs));
  const PlaceHistogram one = count_places(*image, 32, 16, 1U << 20U, 1);
  std::uint64_t total = 0;
  for (const std::uint32_t count : one.counts) total += count;
  EXPECT_EQ(total, 23U * 17U * 11U);
  EXPECT_EQ(count_places(*image, 32, 16, 1U << 20U, 2).counts, one.counts);
  EXPECT_DOUBLE_EQ(one.range.upper.y, highest_gradient(*image));
  // Of fewer points, evenly taken.
  total = 0;
  for (const std::uint32_t count : count_places(*image, 32, 16, 1000).counts) total += count;
  EXPECT_GT(total, 500U);
  EXPECT_LE(total, 1000U);
}

TEST(ValueGradient, OfNoValuesIsNone) {
  const auto image = image_of(
      sampled_block(Index3(5), Vec3(1.0), ScalarType::kFloat32, [](const Vec3&) { return std::nan(""); }));
  EXPECT_EQ(highest_gradient(*image), 0.0);
  EXPECT_EQ(place_range(*image).upper, Vec2(1.0));
  EXPECT_LT(gradient_ranges(*image, Index3(1)).ranges[0].highest, 0.0);
}

// The table holds the function at its entries; bricks whose ranges meet none of what it shows are empty.
TEST(ValueGradient, EmptyBricksAreThoseWhoseValuesAndGradientsMeetNoRegion) {
  const RegionTransfer transfer(
      {{.corners = {Vec2(0.4, 2.0), Vec2(0.6, 4.0), Vec2(0.0)}, .opacity = 0.5, .soft = 0.5}});
  const RegionTable table = make_region_table(transfer, {{0.0, 0.0}, {1.0, 8.0}}, 101);
  EXPECT_NEAR(table.entries[50 + 101 * 96][3], transfer.at({0.5, 8.0 * 96 / 255}).depth, 1e-6);
  EXPECT_TRUE(table.clear(50, 0));
  const BrickRanges values{{4, 1, 1}, {{0.0F, 0.3F}, {0.3F, 0.5F}, {0.3F, 0.5F}, {0.45F, 0.55F}}};
  const GradientRanges slopes{{{0.0, 8.0}, {0.0, 1.9}, {2.5, 3.0}, {4.2, 7.0}}};
  const auto empty = empty_distances(values, slopes, table, 0.0, 1.0, 8.0);
  EXPECT_EQ(empty, (std::vector<std::uint8_t>{2, 1, 0, 1}));
  EXPECT_GT(deepest_entries(table)[50].depth, 0.5F);
  EXPECT_EQ(deepest_entries(table)[20].depth, 0.0F);
}

}  // namespace
}  // namespace palpate::test
