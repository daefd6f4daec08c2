// A mask lies where its affine says, however its voxels are stored.

#include "common/field/voxel_mask.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

/// The voxels of `image` whose centres lie in the half space x > `from`, stored by `inside` and `outside`.
VoxelMask half_space(const UniformTopology& image, double from, float inside = 1.0F, float outside = 0.0F) {
  std::vector<float> values;
  for (int k = 0; k < image.points.z; ++k) {
    for (int j = 0; j < image.points.y; ++j) {
      for (int i = 0; i < image.points.x; ++i) {
        const Vec3 x = image.origin + image.axes * Vec3(i, j, k);
        values.push_back(x.x > from ? inside : outside);
      }
    }
  }
  return {image, make_array("mask", Association::kPoint, 1, std::span<const float>(values))};
}

/// An image of 10 x 8 x 6 mm and voxels of 1 mm, its axes stored as columns of `order` say.
UniformTopology stored(const Mat3& order) {
  const Vec3 size = glm::abs(glm::transpose(order) * Vec3{10.0, 8.0, 6.0});
  UniformTopology image{Index3(glm::round(size)), Vec3{0.0}, order};
  for (int axis = 0; axis < 3; ++axis) {
    for (int x = 0; x < 3; ++x) {
      if (order[axis][x] < 0.0) image.origin[x] = size[axis] - 1.0;
    }
  }
  return image;
}

const std::vector<Mat3> kOrders{Mat3{1.0}, Mat3{Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}},
                                Mat3{Vec3{0, 0, 1}, Vec3{0, -1, 0}, Vec3{1, 0, 0}},
                                Mat3{Vec3{0, 1, 0}, Vec3{-1, 0, 0}, Vec3{0, 0, -1}}};

TEST(VoxelMask, IsTheSameInEveryOrderOfStorage) {
  const UniformTopology image = stored(kOrders[0]);
  for (const Mat3& order : kOrders) {
    const VoxelMask mask = half_space(stored(order), 3.5);
    EXPECT_EQ(mask.size(), 6U * 8U * 6U);
    const MaskedVoxels masked = masked_voxels(mask, image);
    EXPECT_EQ(masked.taken, mask.size());
    EXPECT_EQ(masked.beyond, 0U);
    for (std::size_t v = 0; v < masked.inside.size(); ++v) EXPECT_EQ(masked.inside[v], v % 10 > 3 ? 1 : 0);
  }
}

TEST(VoxelMask, OfAnotherResolutionOrObliqueGoesByTheNearestVoxel) {
  // Voxels of 2 mm from -0.5 mm: they hold pairs of the image's.
  const UniformTopology coarse{{5, 4, 3}, Vec3{0.5}, Mat3{2.0}};
  const UniformTopology image = stored(kOrders[0]);
  EXPECT_EQ(masked_voxels(half_space(coarse, 3.5), image).taken, 6U * 8U * 6U);
  const double c = std::cos(0.4), s = std::sin(0.4);
  const Mat3 turn{Vec3{c, s, 0.0}, Vec3{-s, c, 0.0}, Vec3{0.0, 0.0, 1.0}};
  const UniformTopology oblique{{200, 200, 12}, Vec3{-10.0, -20.0, -1.0}, 0.2 * turn};
  const VoxelMask mask = half_space(oblique, 3.5);
  constexpr double kVoxel = 0.2 * 0.71;  // half a diagonal of the mask's voxels across z
  for (double x = 0.0; x < 9.0; x += 0.37) {
    if (std::abs(x - 3.5) > kVoxel && mask.covers({x, 4.0, 0.3})) {
      EXPECT_EQ(mask.contains({x, 4.0, 0.3}), x > 3.5) << x;
    }
  }
}

TEST(VoxelMask, TakesValuesAboveOneHalfAlone) {
  const UniformTopology image = stored(kOrders[0]);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float outside : {nan, -3.0F, 0.0F, 0.5F, -std::numeric_limits<float>::infinity()})
    EXPECT_EQ(half_space(image, 3.5, 0.51F, outside).size(), 6U * 8U * 6U) << outside;
  EXPECT_EQ(half_space(image, 3.5, 0.5F).size(), 0U);
}

TEST(VoxelMask, EndsWhereItsImageEnds) {
  UniformTopology beside = stored(kOrders[0]);
  const VoxelMask mask = half_space(beside, -1.0);
  EXPECT_TRUE(mask.contains({-0.49, 0.0, 0.0}));
  EXPECT_FALSE(mask.contains({-0.51, 0.0, 0.0}));
  EXPECT_FALSE(mask.contains(Vec3{std::numeric_limits<double>::quiet_NaN()}));
  beside.origin.x = 6.0;
  const MaskedVoxels masked = masked_voxels(mask, beside);
  EXPECT_EQ(masked.taken, 4U * 8U * 6U);
  EXPECT_EQ(masked.beyond, 6U * 8U * 6U);
  EXPECT_EQ(mask.size_in(beside), 4U * 8U * 6U);
  beside.origin.x = 20.0;
  EXPECT_EQ(mask.size_in(beside), 0U);
}

}  // namespace
}  // namespace palpate::test
