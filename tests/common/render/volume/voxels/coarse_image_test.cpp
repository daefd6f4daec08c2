// Coarser volumes of the same place.

#include "common/render/volume/voxels/coarse_image.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "tests/common/render/volume/sample_volumes.h"

namespace palpate::test {
namespace {

VolumeImage image_of(const Index3& points, const std::vector<float>& numbers) {
  VolumeImage image;
  image.points = points;
  image.origin = {1.0, -2.0, 3.0};
  image.axes = Mat3(Vec3(0.5, 0.1, 0.0), Vec3(0.0, 2.0, 0.0), Vec3(0.3, 0.0, 1e-3));
  auto owned = std::make_shared<const std::vector<float>>(numbers);
  image.bytes = std::as_bytes(std::span<const float>(*owned));
  image.owner = std::move(owned);
  image.lowest = -7.0;
  image.highest = 9.0;
  return image;
}

// a + b.g at the points of a grid.
std::vector<float> ramp(const Index3& n, double a, const Vec3& b) {
  std::vector<float> numbers;
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) {
      for (int x = 0; x < n.x; ++x) numbers.push_back(static_cast<float>(a + glm::dot(b, Vec3(x, y, z))));
    }
  }
  return numbers;
}

TEST(CoarseImage, KeepsThePlaceAndHalvesThePoints) {
  for (const Index3& n : {Index3(9, 8, 5), Index3(3, 4, 2), Index3(1, 17, 6), Index3(2, 2, 1)}) {
    const VolumeImage fine = image_of(n, ramp(n, 1.0, Vec3(0.0)));
    const auto coarse = coarse_image(fine, 1);
    for (int a = 0; a < 3; ++a) {
      EXPECT_EQ(coarse->points[a], n[a] > 2 ? n[a] / 2 + 1 : n[a]);
      EXPECT_LT(glm::length(coarse->axes * coarse->upper() - fine.axes * fine.upper()), 1e-12);
    }
    EXPECT_EQ(coarse->origin, fine.origin);
    EXPECT_EQ(coarse->lowest, fine.lowest);
    EXPECT_EQ(coarse->highest, fine.highest);
    for (std::size_t i = 0; i < coarse->point_count(); ++i) EXPECT_EQ(coarse->number(i), 1.0);
  }
}

TEST(CoarseImage, IsExactOnRampsAwayFromTheBorder) {
  const Index3 n(17, 9, 13);
  const Vec3 slope(0.5, -1.0, 2.0);
  const auto coarse = coarse_image(image_of(n, ramp(n, 3.0, slope)), 1);
  const Index3 m = coarse->points;
  for (int z = 1; z + 1 < m.z; ++z) {
    for (int y = 1; y + 1 < m.y; ++y) {
      for (int x = 1; x + 1 < m.x; ++x) {
        const auto at = static_cast<std::size_t>(x + m.x * (y + m.y * z));
        EXPECT_NEAR(coarse->number(at), 3.0 + glm::dot(slope, 2.0 * Vec3(x, y, z)), 1e-4);
      }
    }
  }
}

// Each level has half the points of the one before, and two levels are one twice.
TEST(CoarseImage, LevelsFollowOneAnother) {
  const Index3 n(16, 11, 7);
  const VolumeImage fine = image_of(n, ramp(n, 0.0, {1.0, 0.25, -3.0}));
  const auto once = coarse_image(fine, 1), twice = coarse_image(*once, 1), both = coarse_image(fine, 2);
  ASSERT_EQ(twice->points, both->points);
  for (std::size_t i = 0; i < both->point_count(); ++i)
    EXPECT_NEAR(twice->number(i), both->number(i), 1e-6 * std::abs(both->number(i)) + 1e-6);
  EXPECT_LE(coarse_image(fine, 9)->point_count(), 8U);
}

TEST(CoarseImage, LeavesOutWhatIsNotFinite) {
  const Index3 n(5, 1, 1);
  const float hole = std::numeric_limits<float>::quiet_NaN();
  const auto coarse = coarse_image(image_of(n, {1.0F, hole, 3.0F, 5.0F, hole}), 1);
  EXPECT_EQ(coarse->number(0), 1.0);
  EXPECT_NEAR(coarse->number(1), (1.0 * 3.0 + 0.5 * 5.0) / 1.5, 1e-6);
  EXPECT_TRUE(std::isnan(coarse->number(2)));
}

TEST(CoarseImage, KeepsTheTypeOfItsNumbers) {
  for (const ScalarType type : {ScalarType::kUint8, ScalarType::kUint16, ScalarType::kFloat32}) {
    const auto fine = sampled_view(blobs, type, 21).image;
    const auto coarse = coarse_image(*fine, 1);
    EXPECT_EQ(coarse->type, type);
    EXPECT_EQ(coarse->scale, fine->scale);
    double worst = 0.0;
    // Even points are those of the coarse image: a smooth scalar is close to its means.
    for (int z = 1; z < 10; ++z) {
      for (int x = 1; x < 10; ++x) {
        const double mean = coarse->value(static_cast<std::size_t>(x + 11 * (5 + 11 * z)));
        const double there = fine->value(static_cast<std::size_t>(2 * x + 21 * (10 + 21 * 2 * z)));
        worst = std::max(worst, std::abs(mean - there));
      }
    }
    // Weights 1/4, 1/2, 1/4 an axis add a quarter of the second differences: h = 0.1 and at most 36, 25 and
    // 16 times half of the values' 1.
    const double one = type == ScalarType::kUint8 ? 255.0 : type == ScalarType::kUint16 ? 65535.0 : 1.0;
    EXPECT_LT(worst, 0.25 * 0.01 * 0.5 * (36.0 + 25.0 + 16.0) * one + (one > 1.0 ? 0.5 : 0.0));
    EXPECT_GT(worst, 0.05 * one);
  }
}

}  // namespace
}  // namespace palpate::test
