// Volumes in bricks look as they do whole, and stay within the memory given.

#include "common/render/volume/voxels/voxel_bricks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/render/volume/volume_block.h"
#include "common/render/volume/volume_picture.h"
#include "common/render/volume/voxels/coarse_image.h"
#include "common/render/volume/voxels/seen_bricks.h"
#include "tests/common/render/lens/sample_lenses.h"

namespace palpate::test {
namespace {

constexpr int kSize = 64;
constexpr double kLevel = 1.0 / 255.0;

double brightest(const FloatImage& image) {
  return static_cast<double>(*std::max_element(image.rgba.begin(), image.rgba.end()));
}

// Keeps the shaders of both ways from one test to the next.
class BrickedPictures : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    whole_ = std::make_unique<VolumePicture>(kSize, kSize);
    bricked_ = std::make_unique<VolumePicture>(kSize, kSize, VolumePicture::Context::kCurrent);
  }
  static void TearDownTestSuite() {
    bricked_.reset();
    whole_.reset();
  }

  // In bricks against whole: something is seen, and it is the same.
  static void expect_same(VolumeView view, const Camera& camera, const std::string& what, int cells = 16) {
    view.storage.brick_cells = 0;
    const FloatImage whole = whole_->draw(view, camera);
    EXPECT_GT(brightest(whole), 0.1) << what;
    view.storage.brick_cells = cells;
    EXPECT_LE(worst_difference(bricked_->draw(view, camera), whole), kLevel) << what;
  }

  static inline std::unique_ptr<VolumePicture> whole_, bricked_;
};

VolumeView lit_view(ScalarType type = ScalarType::kFloat32, const Index3& points = {41, 33, 38},
                    const Vec3& spacing = Vec3(0.05)) {
  VolumeView view = view_of(sampled_block(points, spacing, type, blobs));
  view.shading = true;
  view.table_entries = 64;
  return view;
}

TEST_F(BrickedPictures, LookAsTheWholeForEveryTypeOfVoxels) {
  for (const ScalarType type : {ScalarType::kUint8, ScalarType::kUint16, ScalarType::kFloat32}) {
    const VolumeView view = lit_view(type);
    expect_same(view, camera_of(view), name_of(type));
  }
}

TEST_F(BrickedPictures, LookAsTheWholeAtEverySize) {
  const VolumeView view = lit_view();
  for (const int cells : {8, 32, 64})
    expect_same(view, camera_of(view), "bricks of " + std::to_string(cells), cells);
}

TEST_F(BrickedPictures, LookAsTheWholeWithoutLeapsOverEmptyOnes) {
  VolumeView view = lit_view();
  view.skip_empty = false;
  expect_same(view, camera_of(view), "no leaps");
}

TEST_F(BrickedPictures, LookAsTheWholeAtBordersAndAlongFaces) {
  // Points that end at a brick's face, one before it and one behind it.
  for (const int points : {32, 33, 34}) {
    VolumeView view = lit_view(ScalarType::kFloat32, Index3(points));
    // All of it is seen, up to its borders.
    view.transfer = spread(ColorTransfer({{0.0, {0.1F, 0.2F, 0.9F}, 0.05}, {1.0, {1.0F, 0.6F, 0.2F}, 0.2}}),
                           view.image->lowest, view.image->highest);
    expect_same(view, camera_of(view), "perspective");
    expect_same(view, camera_of(view, {.azimuth = 0.0, .elevation = 0.0}, Projection::kOrthographic),
                "along an axis");
  }
}

TEST_F(BrickedPictures, LookAsTheWholeWithUnevenSpacingAndThinAxes) {
  const VolumeView uneven = lit_view(ScalarType::kUint16, {20, 41, 35}, {0.1, 0.02, 0.05});
  expect_same(uneven, camera_of(uneven), "uneven");
  for (const Index3& points : {Index3(1, 30, 30), Index3(30, 30, 1), Index3(2, 40, 3)}) {
    VolumeView thin = lit_view(ScalarType::kUint8, points);
    thin.opacity_length = 0.01;
    expect_same(thin, camera_of(thin), std::to_string(points.x) + " points along x");
  }
}

TEST_F(BrickedPictures, LookAsTheWholeThroughLensesOfEveryShape) {
  for (const NamedLens& one : lenses()) {
    VolumeView view = lit_view();
    view.lenses = {one.lens};
    expect_same(view, camera_of(view), one.name);
    view.lenses.front().magnification = 2.0;
    expect_same(view, camera_of(view), one.name + " that enlarges");
  }
}

TEST_F(BrickedPictures, LookAsTheWholeAroundAContextDrawnAlone) {
  for (const int level : {0, 1}) {
    VolumeView view = lit_view();
    view.lenses = {lenses().front().lens};
    view.context = {.viewport = 0.5, .level = level};
    expect_same(view, camera_of(view), "context of level " + std::to_string(level));
    view.lenses.front().transfer.reset();
    view.lenses.front().transition = 0.6;
    expect_same(view, camera_of(view), "blended context of level " + std::to_string(level));
  }
}

TEST_F(BrickedPictures, LookAsTheWholeBehindACut) {
  VolumeView view = lit_view();
  view.cuts = {{.kept = {.outward = glm::normalize(Vec3(0.3, -1.0, 0.2)), .offset = 0.1}}};
  expect_same(view, camera_of(view), "cut");
}

// Whose slabs are kept while it moves.
TEST_F(BrickedPictures, LookAsTheWholeWhileAPlaneMoves) {
  VolumeView view = lit_view();
  const Camera camera = camera_of(view);
  for (const double offset : {0.3, 0.28, 0.26, 0.1}) {
    view.cuts = {{.kept = {.outward = glm::normalize(Vec3(0.3, -1.0, 0.2)), .offset = offset}}};
    expect_same(view, camera, "plane at " + std::to_string(offset));
  }
  EXPECT_GT(bricked_->cost().slab_bytes, 0U);
}

TEST_F(BrickedPictures, AMissingValueHidesItsCellsAlone) {
  DataSet block = sampled_block(Index3(41), Vec3(0.05), ScalarType::kFloat32, blobs);
  auto numbers = std::make_shared<std::vector<float>>(41U * 41U * 41U);
  std::memcpy(numbers->data(), block.arrays[0].bytes.data(), block.arrays[0].bytes.size());
  // At corners of bricks, in their layers, and amid them.
  for (const Index3& at : {Index3(16, 16, 16), Index3(24, 20, 19), Index3(17, 23, 22), Index3(20, 15, 20)})
    (*numbers)[static_cast<std::size_t>(at.x + 41 * (at.y + 41 * at.z))] =
        std::numeric_limits<float>::quiet_NaN();
  block.arrays[0].bytes = std::as_bytes(std::span<const float>(*numbers));
  block.arrays[0].owner = numbers;
  VolumeView view = view_of(block);
  expect_same(view, camera_of(view, {.azimuth = 20.0, .elevation = 25.0}), "holes");
}

// A ball of noise about the middle; nothing, of one value, around it.
double ball(const Vec3& x) { return glm::length(x) < 0.4 ? 0.75 + 0.25 * std::sin(40.0 * x.x * x.y) : 0.0; }

TEST(VoxelBricks, HoldOnlyWhatIsSeen) {
  VolumeView view = view_of(sampled_block(Index3(97), Vec3(0.02), ScalarType::kFloat32, ball));
  const Camera camera = camera_of(view);
  VolumePicture picture(kSize, kSize);
  const FloatImage whole = picture.draw(view, camera);
  const std::uint64_t dense = view.image->bytes.size();
  EXPECT_EQ(picture.cost().voxel_bytes, dense);
  view.storage = {.memory = dense / 3, .brick_cells = 16};
  EXPECT_LE(worst_difference(picture.draw(view, camera), whole), kLevel) << "at its own resolution";
  EXPECT_LE(picture.cost().voxel_bytes, dense / 3);
  EXPECT_GT(picture.cost().voxel_bytes, dense / 40);
}

// A wire of one voxel is lost in means of eight, a cube is not.
TEST(VoxelBricks, SayHowMuchCoarserVoxelsHide) {
  const auto at = [](double x) { return std::lround(32.0 * (x + 1.0)); };
  const auto wire_and_cube = [&](const Vec3& x) {
    const bool wire = at(x.y) == 20 && at(x.z) == 20;
    const auto in = [&](double v) { return at(v) >= 40 && at(v) <= 56; };
    return wire || (in(x.x) && in(x.y) && in(x.z)) ? 1.0 : 0.0;
  };
  VolumeView view = view_of(sampled_block(Index3(65), Vec3(2.0 / 64.0), ScalarType::kUint8, wire_and_cube));
  view.transfer = spread(ColorTransfer({{0.6, Vec3f(1.0F), 0.0}, {0.7, Vec3f(1.0F), 0.5}}),
                         view.image->lowest, view.image->highest);
  VolumeView coarser = view;
  coarser.image = coarse_image(*view.image, 1);
  const auto hidden = [&] {
    return hidden_share(view, brick_ranges(*view.image), coarser, brick_ranges(*coarser.image));
  };
  // Eight bricks along the wire; four along each edge of the cube, with those that it touches.
  EXPECT_DOUBLE_EQ(hidden(), 8.0 / (8.0 + 64.0));
  view.transfer = coarser.transfer = spread(ColorTransfer({{0.0, Vec3f(1.0F), 0.0}, {0.7, Vec3f(1.0F), 0.5}}),
                                            view.image->lowest, view.image->highest);
  EXPECT_EQ(hidden(), 0.0) << "all that is seen is seen, though fainter";
}

TEST(VoxelBricks, NeverTakeMoreMemoryThanGiven) {
  VolumeView view = lit_view(ScalarType::kFloat32, Index3(65), Vec3(0.03));
  view.transfer = spread(ColorTransfer({{0.0, Vec3f(0.3F), 0.05}, {1.0, Vec3f(1.0F), 0.2}}), 0.0, 1.0);
  const Camera camera = camera_of(view);
  VolumePicture picture(kSize, kSize);
  const FloatImage fine = picture.draw(view, camera);
  const std::uint64_t dense = view.image->bytes.size();
  view.lenses = {lenses().front().lens};
  for (const bool alone : {false, true}) {
    view.context.level = alone ? 1 : 0;
    for (const std::uint64_t part : {2U, 9U, 40U, 300U}) {
      view.storage.memory = dense / part;
      EXPECT_GT(brightest(picture.draw(view, camera)), 0.5 * brightest(fine)) << part;
      const VolumePass::Cost cost = picture.cost();
      EXPECT_LE(cost.voxel_bytes, dense / part);
      EXPECT_GT(cost.voxel_bytes, dense / part / 20) << "the finest level that fits";
    }
  }
  view.storage.memory = 4;
  EXPECT_THROW(static_cast<void>(picture.draw(view, camera)), Error);
  view.storage.memory = 0;
  view.lenses.clear();
  EXPECT_LE(worst_difference(picture.draw(view, camera), fine), 0.0) << "whole again";
}

TEST(VoxelBricks, FollowTransferFunctions) {
  VolumeView view = view_of(sampled_block(Index3(65), Vec3(0.03), ScalarType::kFloat32, blobs));
  const Camera camera = camera_of(view);
  VolumePicture bricked(kSize, kSize), whole(kSize, kSize, VolumePicture::Context::kCurrent);
  for (const double lowest : {0.9, 0.7, 0.4, 0.95, 0.6}) {
    view.transfer = ColorTransfer({{lowest, Vec3f(0.2F), 0.0}, {1.0, Vec3f(1.0F), 0.3}});
    view.storage.brick_cells = 0;
    const FloatImage expected = whole.draw(view, camera);
    view.storage.brick_cells = 8;
    EXPECT_LE(worst_difference(bricked.draw(view, camera), expected), kLevel) << lowest;
  }
}

TEST(VoxelBricks, ShareOneLayerOfPoints) {
  VolumeImage image;
  image.points = {33, 34, 1};
  const BrickLayout layout = brick_layout(image, 16);
  EXPECT_EQ(layout.bricks, Index3(2, 3, 1)) << "32, 33 and no cells";
  EXPECT_EQ(layout.points, Index3(17, 17, 2));
}

TEST(VoxelBricks, PoolsAreNearlyAsSmallAsTheirBricks) {
  const BrickLayout layout{.cells = 32, .bricks = Index3(100), .points = Index3(33)};
  for (const std::size_t count : {1U, 2U, 7U, 64U, 1000U, 12345U}) {
    const Index3 size = pool_size(count, layout, 2048);
    const auto places = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                        static_cast<std::size_t>(size.z);
    EXPECT_GE(places, count);
    EXPECT_LE(static_cast<double>(places), 1.3 * static_cast<double>(count) + 1.0);
    EXPECT_LE(33 * std::max({size.x, size.y, size.z}), 2048);
  }
  EXPECT_EQ(pool_size(28, layout, 100), Index3(0)) << "27 fit";
  EXPECT_EQ(pool_size(27, layout, 100), Index3(3));
  EXPECT_EQ(bricked_bytes(28, layout, ScalarType::kUint8, 100), std::numeric_limits<std::uint64_t>::max());
}

}  // namespace
}  // namespace palpate::test
