#include "common/render/volume/voxels/brick_map.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/render/volume/tile_pass.h"
#include "tests/common/render/volume/sample_volumes.h"

namespace palpate::test {
namespace {

std::shared_ptr<const VolumeImage> image_of(const Index3& points, std::vector<float> values) {
  return make_volume_image(block_of(points, Vec3(1.0), std::move(values), ScalarType::kFloat32), "s", "test");
}

std::size_t index_of(const Index3& n, int x, int y, int z) {
  return static_cast<std::size_t>(x) +
         static_cast<std::size_t>(n.x) *
             (static_cast<std::size_t>(y) + static_cast<std::size_t>(n.y) * static_cast<std::size_t>(z));
}

// Clear up to the value 1, seen beyond.
const std::vector<OpticalEntry> kSeenAboveOne{{Vec3f(0.0F), 0.0F}, {Vec3f(0.0F), 0.0F}, {Vec3f(1.0F), 1.0F}};

TEST(BrickRanges, HoldThePointsOnEverySideOfTheirCells) {
  // A point on the border of bricks counts for all that it touches: 8 at an inner corner.
  const Index3 n{17, 17, 17};
  for (const Index3 at :
       {Index3{8, 8, 8}, Index3{8, 4, 8}, Index3{0, 0, 0}, Index3{16, 16, 16}, Index3{3, 8, 12}}) {
    std::vector<float> values(17 * 17 * 17, 0.0F);
    values[index_of(n, at.x, at.y, at.z)] = 5.0F;
    const BrickRanges ranges = brick_ranges(*image_of(n, values));
    ASSERT_EQ(ranges.bricks, Index3(2));
    for (int z = 0; z < 2; ++z) {
      for (int y = 0; y < 2; ++y) {
        for (int x = 0; x < 2; ++x) {
          bool touches = true;
          for (int a = 0; a < 3; ++a) {
            const int brick = a == 0 ? x : a == 1 ? y : z;
            touches = touches && at[a] >= 8 * brick && at[a] <= 8 * brick + 8;
          }
          EXPECT_EQ(ranges.ranges[index_of({2, 2, 2}, x, y, z)].highest, touches ? 5.0F : 0.0F);
        }
      }
    }
  }
}

TEST(BrickRanges, PassOverNan) {
  const float nan = std::nanf("");
  std::vector<float> values(9 * 9 * 9, nan);
  EXPECT_LT(brick_ranges(*image_of({9, 9, 9}, values)).ranges[0].highest,
            brick_ranges(*image_of({9, 9, 9}, values)).ranges[0].lowest);
  values[100] = 3.0F;
  EXPECT_EQ(brick_ranges(*image_of({9, 9, 9}, values)).ranges[0].lowest, 3.0F);
  EXPECT_EQ(brick_ranges(*image_of({9, 9, 9}, values)).ranges[0].highest, 3.0F);
}

TEST(BrickRanges, OfThinVolumesAreOneBrickThick) {
  EXPECT_EQ(brick_ranges(*image_of({20, 1, 2}, std::vector<float>(40, 0.0F))).bricks, Index3(3, 1, 1));
}

TEST(EmptyDistances, AreThoseOfTheNearestSeenBrick) {
  std::mt19937 random(7);
  BrickRanges ranges;
  ranges.bricks = {9, 7, 11};
  std::uniform_int_distribution<int> one_in(0, 60);
  for (int i = 0; i < 9 * 7 * 11; ++i) {
    const bool seen = one_in(random) == 0;
    ranges.ranges.push_back({0.0F, seen ? 1.5F : 0.5F});
  }
  const std::vector<std::uint8_t> distances = empty_distances(ranges, kSeenAboveOne, 0.0, 2.0);
  for (int z = 0; z < 11; ++z) {
    for (int y = 0; y < 7; ++y) {
      for (int x = 0; x < 9; ++x) {
        int nearest = 255;
        for (int k = 0; k < 11; ++k) {
          for (int j = 0; j < 7; ++j) {
            for (int i = 0; i < 9; ++i) {
              if (ranges.ranges[index_of(ranges.bricks, i, j, k)].highest < 1.0F) continue;
              nearest = std::min(nearest, std::max({std::abs(i - x), std::abs(j - y), std::abs(k - z)}));
            }
          }
        }
        ASSERT_EQ(distances[index_of(ranges.bricks, x, y, z)], nearest) << x << " " << y << " " << z;
      }
    }
  }
}

TEST(EmptyDistances, TakeValuesBeyondTheTableAsItsEnds) {
  const auto distance_of = [](float lowest, float highest, const std::vector<OpticalEntry>& entries) {
    BrickRanges ranges;
    ranges.bricks = Index3(1);
    ranges.ranges = {{lowest, highest}};
    return int{empty_distances(ranges, entries, 0.0, 2.0)[0]};
  };
  EXPECT_EQ(distance_of(-9.0F, -1.0F, kSeenAboveOne), 255);
  EXPECT_EQ(distance_of(-9.0F, 0.9F, kSeenAboveOne), 255);
  EXPECT_EQ(distance_of(-9.0F, 1.1F, kSeenAboveOne), 0);
  EXPECT_EQ(distance_of(5.0F, 9.0F, kSeenAboveOne), 0);
  EXPECT_EQ(distance_of(5.0F, 9.0F, {{Vec3f(0.0F), 1.0F}, {Vec3f(0.0F), 0.0F}}), 255);
}

TEST(ShellBricks, LeaveOutThoseBetweenOthers) {
  const Index3 bricks{5, 6, 7};
  std::vector<std::uint8_t> maps(2 * 5 * 6 * 7, 1);
  EXPECT_TRUE(shell_bricks(bricks, maps).empty());
  // A block of 3 x 3 x 3 whose middle is seen in the other map alone.
  for (int z = 2; z < 5; ++z) {
    for (int y = 1; y < 4; ++y) {
      for (int x = 1; x < 4; ++x) maps[index_of(bricks, x, y, z)] = 0;
    }
  }
  const std::uint32_t middle = 2U | 2U << 10U | 3U << 20U;
  std::vector<std::uint32_t> shell = shell_bricks(bricks, maps);
  EXPECT_EQ(shell.size(), 26U);
  EXPECT_EQ(std::count(shell.begin(), shell.end(), middle), 0);
  maps[index_of(bricks, 2, 2, 3)] = 1;
  EXPECT_EQ(shell_bricks(bricks, maps).size(), 26U);
  maps[5 * 6 * 7 + index_of(bricks, 2, 2, 3)] = 0;
  EXPECT_EQ(shell_bricks(bricks, maps).size(), 26U);
  // All of the volume: its border.
  std::fill(maps.begin(), maps.end(), std::uint8_t{0});
  EXPECT_EQ(shell_bricks(bricks, maps).size(), 5U * 6U * 7U - 3U * 4U * 5U);
}

TEST(GapShare, CountsEmptyBricksBetweenOthersInARow) {
  const Index3 bricks{7, 2, 1};
  // Rows of two maps; a brick shows something in either.
  const std::vector<std::uint8_t> maps{2, 0, 1, 1, 0, 1, 2, 3, 3, 3, 3, 3, 3, 3,
                                       2, 1, 1, 0, 1, 1, 2, 3, 3, 0, 3, 3, 3, 3};
  EXPECT_DOUBLE_EQ(gap_share(bricks, maps), 1.0 / 5.0) << "one of four in the first row, one alone";
  EXPECT_EQ(gap_share(bricks, std::vector<std::uint8_t>(14, 3)), 0.0);
  EXPECT_EQ(gap_share(bricks, std::vector<std::uint8_t>(14, 0)), 0.0);
  std::vector<std::uint8_t> ends(14, 3);
  ends[0] = ends[6] = 0;
  EXPECT_DOUBLE_EQ(gap_share(bricks, ends), 5.0 / 7.0);
}

}  // namespace
}  // namespace palpate::test
