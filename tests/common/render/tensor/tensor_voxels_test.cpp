#include "common/render/tensor/tensor_voxels.h"

#include <limits>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/tensor/diffusion_measures.h"
#include "tests/common/render/tensor/sample_tensors.h"

namespace palpate::test {
namespace {

const Mat3 kTurned{Vec3{0.8, 0.6, 0.0}, Vec3{-1.2, 1.6, 0.0}, Vec3{0.0, 0.0, 3.0}};
const Mat3 kSheared{Vec3{1.0, 0.0, 0.0}, Vec3{0.4, 1.0, 0.0}, Vec3{0.0, 0.3, -2.0}};

std::size_t index_of(const TensorVoxels& image, const Index3& at) {
  return static_cast<std::size_t>(at.x + image.points.x * (at.y + image.points.y * at.z));
}

TEST(TensorVoxels, HasTheColourOfEachVoxelsOwnTensorOnAnyAxes) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  for (const Mat3& axes : {Mat3(-1.0), kTurned, kSheared}) {
    const UniformTopology lattice = centred_lattice({5, 4, 3}, axes);
    const auto direction_at = [](const Vec3& x) { return glm::normalize(x + Vec3(0.1, 0.2, 10.0)); };
    // Every other voxel has no tensor: neighbours must not matter.
    const auto odd = [&](const Vec3& x) {
      const Vec3 g = glm::round(glm::inverse(axes) * (x - lattice.origin));
      return static_cast<int>(g.x + g.y + g.z) % 2 != 0;
    };
    const auto image = sampled_tensors(
        lattice, [&](const Vec3& x) { return odd(x) ? Mat3(nothing) : linear_tensor(direction_at(x)); });
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 5; ++i) {
          const Vec3 x = image->position(Vec3(i, j, k));
          const auto& color = image->directions[index_of(*image, {i, j, k})];
          EXPECT_EQ(image->shows({i, j, k}), !odd(x));
          if (odd(x)) continue;
          const double fa = fractional_anisotropy({1.7e-3, 0.3e-3, 0.3e-3});
          for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(color[static_cast<std::size_t>(c)], 255.0 * fa * std::abs(direction_at(x)[c]), 0.51);
          EXPECT_NEAR(image->anisotropies[index_of(*image, {i, j, k})], 255.0 * fa, 0.51);
        }
      }
    }
  }
}

TEST(TensorVoxels, GridCoordinatesInvertPositionsAtAnyScale) {
  for (const double scale : {1e-30, 1.0, 1e30}) {
    const auto image =
        sampled_tensors(centred_lattice({5, 4, 3}, kTurned * scale), [](const Vec3&) { return Mat3(1.0); });
    const Vec3 g{1.25, 2.5, 0.75}, again = image->grid_coordinates(image->position(g));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(again[c], g[c], 1e-12);
  }
}

TEST(TensorVoxels, ZeroAndNegativeTensorsShowNothing) {
  for (const double trace : {0.0, -1.0}) {
    const auto image =
        sampled_tensors(centred_lattice({2, 2, 2}, Mat3(1.0)), [&](const Vec3&) { return Mat3(trace); });
    EXPECT_FALSE(image->shows({1, 0, 1}));
  }
}

TEST(TensorVoxels, KnowsWhereItsTensorsLie) {
  const auto image = sampled_tensors(centred_lattice({6, 5, 4}, Mat3(1.0)), [](const Vec3& x) {
    return x.x > 0.0 && x.y < 1.5 ? Mat3(1.0) : Mat3(0.0);
  });
  EXPECT_EQ(image->first_shown, Index3(3, 0, 0));
  EXPECT_EQ(image->last_shown, Index3(5, 3, 3));
  EXPECT_EQ(image->shown_bounds().lower, Vec3(0.0, -2.5, -2.0));
  EXPECT_EQ(image->shown_bounds().upper, Vec3(3.0, 1.5, 2.0));
  const auto nothing =
      sampled_tensors(centred_lattice({6, 5, 4}, Mat3(1.0)), [](const Vec3&) { return Mat3(0.0); });
  EXPECT_EQ(nothing->shown_bounds().upper, nothing->bounds().upper);
}

TEST(TensorVoxels, RefusesOtherGrids) {
  DataSet block;
  RectilinearTopology grid;
  grid.coordinates = {std::vector<double>{0.0, 1.0, 3.0}, {0.0, 1.0}, {0.0, 1.0}};
  block.topology = grid;
  block.arrays.push_back(
      make_array("D", Association::kPoint, 6, std::span<const double>(std::vector<double>(72, 1.0))));
  const auto field = make_tensor_field(block, {.array = "D"}, "test");
  EXPECT_THROW((void)make_tensor_voxels(field, "test"), Error);
}

TEST(SliceAxes, AreThoseNearestToTheDatas) {
  using Axes = std::array<int, 3>;
  EXPECT_EQ(slice_axes(Mat3(1.0)), (Axes{0, 1, 2}));
  // i to the feet, j to the left, k to the front.
  EXPECT_EQ(slice_axes(Mat3{Vec3{0.1, 0.0, -2.0}, Vec3{-1.0, 0.2, 0.0}, Vec3{0.0, 3.0, 0.4}}),
            (Axes{1, 2, 0}));
}

TEST(MovedPosition, GoesFromVoxelToVoxelAndStaysInTheImage) {
  const auto image =
      sampled_tensors(centred_lattice({5, 4, 3}, kSheared), [](const Vec3&) { return Mat3(1.0); });
  const Vec3 start = image->position({2.2, 1.0, 1.0});
  EXPECT_NEAR(image->grid_coordinates(moved_position(*image, start, 0, 1)).x, 3.0, 1e-12);
  EXPECT_NEAR(image->grid_coordinates(moved_position(*image, start, 0, 1)).y, 1.0, 1e-12);
  EXPECT_NEAR(image->grid_coordinates(moved_position(*image, start, 0, 100)).x, 4.0, 1e-12);
  EXPECT_NEAR(image->grid_coordinates(moved_position(*image, start, 2, -100)).z, 0.0, 1e-12);
}

}  // namespace
}  // namespace palpate::test
