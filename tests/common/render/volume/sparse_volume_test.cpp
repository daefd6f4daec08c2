// Sparse volumes look as dense ones do: whole, in bricks, paged in, coarser and through lenses.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/grid/sparse/sparse_builder.h"
#include "common/render/volume/volume_picture.h"
#include "common/render/volume/voxels/brick_map.h"
#include "common/render/volume/voxels/coarse_image.h"
#include "common/render/volume/voxels/value_gradient.h"
#include "tests/common/render/lens/sample_lenses.h"
#include "tests/support/sparse_numbers.h"

namespace palpate::test {
namespace {

constexpr int kSize = 64;
constexpr double kLevel = 1.0 / 255.0;
const Index3 kPoints(61, 52, 47);

// Two shells that leave most of the volume empty.
double two_shells(const Vec3& x) {
  const auto shell = [&](const Vec3& middle, double radius) {
    return std::max(0.0, 1.0 - std::abs(glm::distance(x, middle) - radius) / 0.12);
  };
  return std::max(shell({-0.3, -0.2, 0.1}, 0.45), 0.7 * shell({0.6, 0.5, -0.3}, 0.25));
}

DataSet dense_block() { return sampled_block(kPoints, Vec3(0.05), ScalarType::kFloat32, two_shells); }

std::vector<float> numbers_of(const DataSet& block) {
  std::vector<float> numbers(block.arrays.front().tuples);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = static_cast<float>(block.arrays.front().at(i));
  return numbers;
}

DataSet sparse_of(DataSet block, const std::vector<float>& numbers, float background = 0.0F) {
  DataArray& array = block.arrays.front();
  array.sparse =
      make_sparse(numbers, std::get<UniformTopology>(block.topology).points, background, {3, 0, 6});
  array.bytes = {};
  array.owner.reset();
  return block;
}

std::shared_ptr<const VolumeImage> image_of(const DataSet& block) {
  return make_volume_image(block, block.arrays.front().name, "test");
}

struct Both {
  std::shared_ptr<const VolumeImage> dense, sparse;
};

Both both() {
  const DataSet block = dense_block();
  return {image_of(block), image_of(sparse_of(block, numbers_of(block)))};
}

TEST(SparseVolume, RangesOfTheImageAndItsBricksAreTheDenseOnes) {
  const Both images = both();
  ASSERT_NE(images.sparse->sparse, nullptr);
  EXPECT_TRUE(images.sparse->bytes.empty());
  EXPECT_EQ(images.sparse->lowest, images.dense->lowest);
  EXPECT_EQ(images.sparse->highest, images.dense->highest);
  const BrickRanges dense = brick_ranges(*images.dense), sparse = brick_ranges(*images.sparse);
  ASSERT_EQ(sparse.bricks, dense.bricks);
  for (std::size_t i = 0; i < dense.ranges.size(); ++i) {
    ASSERT_EQ(sparse.ranges[i].lowest, dense.ranges[i].lowest) << i;
    ASSERT_EQ(sparse.ranges[i].highest, dense.ranges[i].highest) << i;
  }
}

TEST(SparseVolume, NumbersThatTheGpuWouldLoseAreScaledAndInfiniteOnesShowNothing) {
  const DataSet block = dense_block();
  std::vector<float> numbers = numbers_of(block);
  for (float& v : numbers) v *= 0x1p-100F;
  numbers[1234] = std::numeric_limits<float>::infinity();
  const auto image = image_of(sparse_of(block, numbers));
  EXPECT_TRUE(std::isnan(image->number(1234)));
  double most = 0.0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i == 1234) continue;
    ASSERT_EQ(image->value(i), static_cast<double>(numbers[i]));
    most = std::max(most, std::abs(image->number(i)));
  }
  EXPECT_GE(most, 0.5);
  EXPECT_LE(most, 2.0);
  EXPECT_EQ(image->highest,
            static_cast<double>(*std::max_element(numbers.begin(), numbers.end(), [](float a, float b) {
              return (std::isinf(a) ? -1.0F : a) < (std::isinf(b) ? -1.0F : b);
            })));
}

TEST(SparseVolume, CoarserLevelsAreTheDenseOnesAndStaySparse) {
  const Both images = both();
  for (const int level : {1, 2, 3}) {
    const auto dense = coarse_image(*images.dense, level), sparse = coarse_image(*images.sparse, level);
    ASSERT_NE(sparse->sparse, nullptr);
    ASSERT_EQ(sparse->points, dense->points);
    for (int a = 0; a < 3; ++a) EXPECT_LT(glm::distance(sparse->axes[a], dense->axes[a]), 1e-15);
    for (std::size_t i = 0; i < dense->point_count(); ++i)
      ASSERT_NEAR(sparse->number(i), dense->number(i), 1e-6) << level << " " << i;
  }
  // A solid volume of 1024^3 stays a tree all the way.
  SparseBuilder builder(Index3(0), Index3(1024), 0.0F);
  for (int z = 0; z < 128; ++z) {
    for (int y = 0; y < 128; ++y) {
      for (int x = 0; x < 64; ++x) builder.put({x, y, z}, 1.0F);
    }
  }
  VolumeImage solid;
  solid.points = Index3(1024);
  solid.sparse = builder.finish();
  const auto half = coarse_image(solid, 1);
  EXPECT_EQ(half->points, Index3(513));
  EXPECT_LT(half->sparse->bytes().size(), 24U << 20U) << "only the face between both is leaves";
}

class SparsePictures : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    dense_ = std::make_unique<VolumePicture>(kSize, kSize);
    sparse_ = std::make_unique<VolumePicture>(kSize, kSize, VolumePicture::Context::kCurrent);
  }
  static void TearDownTestSuite() {
    sparse_.reset();
    dense_.reset();
  }

  static void expect_same(VolumeView view, const Both& images, const VoxelStorage& storage,
                          const std::string& what) {
    view.image = images.dense;
    const Camera camera = camera_of(view, {.azimuth = 40.0, .elevation = 25.0});
    const FloatImage dense = dense_->draw(view, camera);
    EXPECT_GT(*std::max_element(dense.rgba.begin(), dense.rgba.end()), 0.2F) << what;
    view.image = images.sparse;
    view.storage = storage;
    FloatImage sparse = sparse_->draw(view, camera);
    for (int i = 0; i < 200 && !sparse_->bricks().complete(); ++i) sparse = sparse_->draw(view, camera);
    EXPECT_LE(worst_difference(sparse, dense), kLevel) << what;
  }

  static VolumeView shown() {
    VolumeView view;
    view.table_entries = 64;
    view.transfer = ColorTransfer(
        {{0.1, {0.2F, 0.3F, 0.9F}, 0.0}, {0.4, {0.9F, 0.6F, 0.2F}, 0.3}, {1.0, {1.0F, 1.0F, 0.8F}, 0.9}});
    view.opacity_length = 0.05;
    return view;
  }

  static inline std::unique_ptr<VolumePicture> dense_, sparse_;
};

TEST_F(SparsePictures, AreThoseOfTheDenseVolume) {
  const Both images = both();
  VolumeView view = shown();
  expect_same(view, images, {}, "whole");
  expect_same(view, images, {.brick_cells = 16}, "in bricks");
  expect_same(view, images, {.brick_cells = 16, .upload = 1 << 16}, "paged in");
  const std::vector<NamedLens> all = lenses();
  view.lenses = {all[0].lens};
  view.cuts = {{{{0.0, 0.0, 1.0}, 0.4}}};
  expect_same(view, images, {.brick_cells = 16}, "through a lens, cut");
  view.planes.shown = true;
  expect_same(view, images, {.brick_cells = 16}, "values on the plane");
  view.planes.shown = false;
  view.context = {.viewport = 1.0, .level = 1};
  expect_same(view, images, {}, "coarser context");
}

TEST_F(SparsePictures, EmptyBricksAreNotHeld) {
  const Both images = both();
  VolumeView view = shown();
  view.image = images.sparse;
  view.storage = {.brick_cells = 16};
  (void)sparse_->draw(view, camera_of(view));
  const BrickShare share = sparse_->bricks();
  EXPECT_EQ(share.all, 4U * 4U * 3U);
  EXPECT_LT(share.held, share.all);
  EXPECT_GT(share.held, 0U);
}

// Blocks of one number are counted without being looked through: the same range and histogram as of all
// points, also where neighbouring blocks have different numbers and none has several.
TEST(SparseVolume, GradientsAreThoseOfAllPoints) {
  DataSet steps = sampled_block(kPoints, Vec3(0.05, 0.1, 0.02), ScalarType::kFloat32, [](const Vec3& x) {
    return x.x > 0.1 ? (x.y > 0.0 ? 2.0 : std::nan("")) : 0.5;
  });
  for (const DataSet& block : {dense_block(), steps}) {
    const auto dense = image_of(block), sparse = image_of(sparse_of(block, numbers_of(block), 0.5F));
    EXPECT_EQ(highest_gradient(*sparse), highest_gradient(*dense));
    const std::size_t all = dense->point_count();
    const PlaceHistogram expected = count_places(*dense, 24, 12, all);
    EXPECT_EQ(count_places(*sparse, 24, 12, 2 * all).counts, expected.counts);
    EXPECT_EQ(count_places(*sparse, 24, 12, 2 * all, 1).counts, expected.counts);
    // Of a part of them shares stay about the same.
    const auto share = [](const PlaceHistogram& histogram, std::size_t bin) {
      std::uint64_t sum = 0;
      for (const std::uint32_t count : histogram.counts) sum += count;
      return static_cast<double>(histogram.counts[bin]) / static_cast<double>(sum);
    };
    const PlaceHistogram some = count_places(*sparse, 24, 12, all / 8);
    EXPECT_LT(some.counts[0], expected.counts[0]);
    for (std::size_t bin = 0; bin < some.counts.size(); ++bin)
      EXPECT_NEAR(share(some, bin), share(expected, bin), 0.05) << bin;
  }
}

}  // namespace
}  // namespace palpate::test
