// Seeds in voxels: where they lie, and what they do not depend on.

#include "common/scene/tensor/voxel_seeds.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/base/error.h"

namespace palpate {
namespace {

// Sheared, and left-handed.
UniformTopology image() {
  return {{6, 5, 4}, {-3.0, 2.0, 1.0}, Mat3{Vec3{-2.0, 0.0, 0.0}, Vec3{0.5, 2.0, 0.0}, Vec3{0.0, -0.3, 3.0}}};
}

bool everywhere(const Vec3& /*center*/) { return true; }

TEST(VoxelSeeds, OneLiesAtTheCentre) {
  const auto seeds = voxel_seeds(image(), everywhere, 1, 1, 1000);
  ASSERT_EQ(seeds.size(), 6U * 5U * 4U);
  EXPECT_EQ(seeds[0], image().origin);
  EXPECT_EQ(seeds[1], image().origin + image().axes[0]);
  EXPECT_EQ(seeds[6], image().origin + image().axes[1]);
}

TEST(VoxelSeeds, SeveralFillTheirVoxelEvenly) {
  constexpr int kEach = 200;
  const auto seeds = voxel_seeds(image(), everywhere, kEach, 3, 100'000);
  const Mat3 to_voxels = glm::inverse(image().axes);
  Vec3 sum{0.0}, squares{0.0};
  std::size_t next = 0;
  for (int k = 0; k < 4; ++k) {
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i < 6; ++i) {
        for (int n = 0; n < kEach; ++n) {
          const Vec3 u = to_voxels * (seeds[next++] - image().origin) - Vec3(i, j, k);
          for (int axis = 0; axis < 3; ++axis) ASSERT_LE(std::abs(u[axis]), 0.5 + 1e-12);
          sum += u;
          squares += u * u;
        }
      }
    }
  }
  // Mean 0 and variance 1/12 of a uniform number, to five standard deviations of so many.
  const auto count = static_cast<double>(seeds.size());
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(sum[axis] / count, 0.0, 5.0 / std::sqrt(12.0 * count));
    EXPECT_NEAR(squares[axis] / count, 1.0 / 12.0, 5.0 / std::sqrt(180.0 * count));
  }
}

TEST(VoxelSeeds, DependOnTheirVoxelAlone) {
  const auto all = voxel_seeds(image(), everywhere, 2, 5, 1000);
  const auto some = voxel_seeds(
      image(), [](const Vec3& x) { return x.z > 5.0; }, 2, 5, 1000);
  ASSERT_FALSE(some.empty());
  for (std::size_t n = 0; n < some.size(); ++n) EXPECT_EQ(some[n], all[all.size() - some.size() + n]);
  EXPECT_NE(voxel_seeds(image(), everywhere, 2, 6, 1000), all);
}

TEST(VoxelSeeds, AreNotMadeWithoutBound) {
  EXPECT_THROW((void)voxel_seeds(image(), everywhere, 10, 1, 1000), Error);
}

}  // namespace
}  // namespace palpate
