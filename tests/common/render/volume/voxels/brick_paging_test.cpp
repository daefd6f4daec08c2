// Volumes in bricks are paged in bit by bit by what the view looks up, and look as the whole in the end.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "common/render/gl/context.h"
#include "common/render/volume/volume_block.h"
#include "common/render/volume/volume_picture.h"
#include "common/render/volume/voxels/brick_demand.h"
#include "common/render/volume/voxels/coarse_image.h"
#include "tests/common/render/lens/sample_lenses.h"

namespace palpate::test {
namespace {

constexpr int kSize = 64;
constexpr double kLevel = 1.0 / 255.0;
constexpr int kCells = 16;
constexpr int kMostPictures = 1000;

double mean_difference(const FloatImage& a, const FloatImage& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i)
    sum += std::abs(static_cast<double>(a.rgba[i]) - static_cast<double>(b.rgba[i]));
  return sum / static_cast<double>(a.rgba.size());
}

// All of it is seen, to its borders.
VolumeView solid_view(ScalarType type = ScalarType::kFloat32) {
  VolumeView view = view_of(sampled_block(Index3(70, 66, 81), Vec3(0.03), type, blobs));
  view.shading = true;
  view.table_entries = 64;
  view.transfer = spread(ColorTransfer({{0.0, {0.1F, 0.2F, 0.9F}, 0.02}, {1.0, {1.0F, 0.6F, 0.2F}, 0.1}}),
                         view.image->lowest, view.image->highest);
  return view;
}

BrickSight sight_of(const VolumeView& view, const Camera& camera) {
  const SceneFrame frame = frame_of(view);
  const ViewTransform transform = view_transform(camera, frame, view.image->bounds(), 1.0);
  return make_brick_sight(
      make_frame_block(camera, transform, palette_of(Background::kDark), false, kSize, kSize), frame);
}

std::uint64_t bytes_of_brick(const VolumeView& view) {
  const Index3 n = brick_layout(*view.image, kCells).points;
  return static_cast<std::uint64_t>(n.x) * static_cast<std::uint64_t>(n.y) * static_cast<std::uint64_t>(n.z) *
         byte_size(view.image->type);
}

TEST(BrickPaging, CoarseBricksStandInUntilThePictureIsThatOfTheWhole) {
  for (const ScalarType type : {ScalarType::kUint8, ScalarType::kUint16, ScalarType::kFloat32}) {
    VolumeView view = solid_view(type);
    const Camera camera = camera_of(view);
    VolumePicture whole(kSize, kSize);
    const FloatImage expected = whole.draw(view, camera);
    VolumePicture paged(kSize, kSize, VolumePicture::Context::kCurrent);
    view.storage = {.brick_cells = kCells, .upload = 10 * bytes_of_brick(view)};
    FloatImage picture = paged.draw(view, camera);
    EXPECT_EQ(paged.bricks().held, 10U);
    EXPECT_EQ(paged.bricks().all, 5U * 5U * 5U);
    EXPECT_GT(worst_difference(picture, expected), kLevel) << "nothing was left out";
    EXPECT_LT(mean_difference(picture, expected), 0.02) << "what stands in is far off";
    std::size_t held = paged.bricks().held;
    for (int i = 0; i < kMostPictures && !paged.bricks().complete(); ++i) {
      picture = paged.draw(view, camera);
      EXPECT_LE(paged.bricks().held - held, 10U) << "more than may be uploaded for a picture";
      EXPECT_GT(paged.bricks().held, held);
      held = paged.bricks().held;
    }
    EXPECT_EQ(held, paged.bricks().wanted);
    EXPECT_LE(worst_difference(picture, expected), kLevel) << name_of(type);
  }
}

TEST(BrickPaging, ThinAxesHaveCoarseBricksToo) {
  for (const Index3& points : {Index3(1, 40, 37), Index3(50, 3, 37)}) {
    VolumeView view = view_of(sampled_block(points, Vec3(0.05), ScalarType::kFloat32, blobs));
    view.opacity_length = 0.02;
    const Camera camera = camera_of(view);
    VolumePicture whole(kSize, kSize);
    const FloatImage expected = whole.draw(view, camera);
    VolumePicture paged(kSize, kSize, VolumePicture::Context::kCurrent);
    view.storage = {.brick_cells = kCells, .upload = 1};
    EXPECT_LT(mean_difference(paged.draw(view, camera), expected), 0.02);
    EXPECT_EQ(paged.bricks().held, 1U) << "one in any case";
    FloatImage picture = expected;
    for (int i = 0; i < kMostPictures && !paged.bricks().complete(); ++i) picture = paged.draw(view, camera);
    EXPECT_LE(worst_difference(picture, expected), kLevel);
  }
}

TEST(BrickPaging, APartThatIsLookedAtCloselyIsHeldAtItsOwnResolution) {
  VolumeView view = solid_view();
  VolumePicture whole(kSize, kSize);
  VolumePicture paged(kSize, kSize, VolumePicture::Context::kCurrent);
  VolumeView small = view;
  small.storage = {.memory = 2 * view.image->bytes.size() / 3, .brick_cells = kCells};
  const Camera far = camera_of(view);
  (void)paged.draw(small, far);
  EXPECT_LT(paged.bricks().all, 125U) << "all of it does not fit: coarser";
  for (const double azimuth : {10.0, 130.0, 250.0}) {
    const Camera close = camera_of(view, {.azimuth = azimuth, .elevation = 30.0, .roll = 0.0, .zoom = 9.0});
    const FloatImage expected = whole.draw(view, close);
    EXPECT_LE(worst_difference(paged.draw(small, close), expected), kLevel) << azimuth;
    EXPECT_EQ(paged.bricks().all, 125U);
    EXPECT_LT(paged.bricks().wanted, 100U);
    EXPECT_LE(paged.bricks().bytes, small.storage.memory);
    EXPECT_GE(paged.bricks().entered - paged.bricks().left, paged.bricks().held);
  }
  // The same ones again have nothing to do; a pool that has room for no more has others leave for each.
  const Camera close = camera_of(view, {.azimuth = 250.0, .elevation = 30.0, .roll = 0.0, .zoom = 9.0});
  const BrickShare before = paged.bricks();
  EXPECT_GT(before.left, 0U) << "bricks of the coarser level, at least";
  (void)paged.draw(small, close);
  EXPECT_EQ(paged.bricks().entered, before.entered);
  EXPECT_EQ(paged.bricks().left, before.left);
}

TEST(BrickPaging, BricksInSightCoverAllThatLookedAtPicturesHold) {
  // Each brick that is left out is beyond a side of the picture with all its corners.
  const VolumeView view = solid_view();
  const BrickLayout layout = brick_layout(*view.image, kCells);
  const std::vector<bool> needed(125, true);
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    for (const double zoom : {1.0, 3.0, 12.0}) {
      const Camera camera =
          camera_of(view, {.azimuth = 33.0, .elevation = 20.0, .roll = 10.0, .zoom = zoom}, projection);
      const BrickSight sight = sight_of(view, camera);
      const std::vector<std::size_t> seen = bricks_in_sight(view, needed, layout, sight);
      std::size_t inside = 0;
      for (std::size_t i = 0; i < needed.size(); ++i) {
        const Index3 at(static_cast<int>(i % 5), static_cast<int>(i / 5 % 5), static_cast<int>(i / 25));
        bool corner_inside = false;
        for (unsigned c = 0; c < 8; ++c) {
          const Vec3 g =
              Vec3(kCells * at) + static_cast<double>(kCells) * Vec3(c & 1U, c >> 1U & 1U, c >> 2U);
          const Vec3 place = sight.frame.scene_from_data(view.image->origin + view.image->axes * g);
          const glm::dvec4 clip = glm::dmat4(sight.clip_from_scene) * glm::dvec4(place, 1.0);
          corner_inside |= std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w;
        }
        inside += corner_inside ? 1 : 0;
        if (corner_inside) {
          EXPECT_EQ(std::count(seen.begin(), seen.end(), i), 1) << i;
        }
      }
      EXPECT_GT(inside, 0U);
      if (zoom == 1.0) {
        EXPECT_EQ(seen.size(), 125U);
      }
      if (zoom == 12.0) {
        EXPECT_LT(seen.size(), 60U);
      }
    }
  }
}

TEST(BrickPaging, BricksInLensesComeFirstThenThoseInFront) {
  VolumeView view = solid_view();
  const BrickLayout layout = brick_layout(*view.image, kCells);
  const std::vector<bool> needed(125, true);
  const Camera camera = camera_of(view, {.azimuth = 0.0, .elevation = 0.0});
  const BrickSight sight = sight_of(view, camera);
  const Vec3 center(-0.6, 0.4, 0.5);
  view.lenses = {{make_sphere(center, 0.2)}};
  const auto middle_of = [&](std::size_t i) {
    const Index3 at(static_cast<int>(i % 5), static_cast<int>(i / 5 % 5), static_cast<int>(i / 25));
    return view.image->origin + view.image->axes * (static_cast<double>(kCells) * (Vec3(at) + 0.5));
  };
  const auto depth = [&](std::size_t i) { return -glm::dot(camera.axes[2], middle_of(i)); };
  std::vector<std::size_t> order = bricks_in_sight(view, needed, layout, sight);
  ASSERT_EQ(order.size(), 125U);
  // The brick about the middle of the lens is among the first few, behind others as it is.
  const auto nearest = std::min_element(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return glm::distance(middle_of(a), center) < glm::distance(middle_of(b), center);
  });
  EXPECT_LT(nearest - order.begin(), 40);
  EXPECT_LE(glm::distance(middle_of(order.front()), center),
            0.2 + std::sqrt(3.0) * (0.5 * kCells + 2.0) * 0.03);
  view.lenses = {{make_sphere(center, 0.2)}};
  view.lenses.front().cut = true;  // nothing is seen there
  order = bricks_in_sight(view, needed, layout, sight);
  for (std::size_t i = 1; i < order.size(); ++i)
    EXPECT_LE(depth(order[i - 1]), depth(order[i]) + 1e-6) << "not from front to back";
}

// Voxels of one level and those of another stand in the pool together: who comes back finds what nobody needed the place of.
TEST(BrickPaging, BricksStayWhileAnotherLevelIsShown) {
  const OffscreenContext context;
  const VolumeView view = solid_view();
  const auto coarser = coarse_image(*view.image, 1);
  const BrickLayout fine = brick_layout(*view.image, kCells), coarse = brick_layout(*coarser, kCells);
  ASSERT_EQ(fine.points, coarse.points);
  const VoxelStorage storage{.memory = bricked_bytes(12, fine, view.image->type, 2048)};
  const auto hold = [&](const std::shared_ptr<const VolumeImage>& image, BrickPool pool,
                        const std::vector<std::size_t>& wanted, std::uint64_t uploads) {
    const BrickLayout layout = brick_layout(*image, kCells);
    VoxelBricks bricks(image, layout, brick_ranges(*image), false, {}, std::move(pool));
    bricks.hold(std::vector<bool>(layout.bricks.x * layout.bricks.y * layout.bricks.z, true), wanted,
                storage);
    EXPECT_EQ(bricks.share().entered, uploads);
    EXPECT_EQ(bricks.share().held, wanted.size());
    return std::move(bricks).give_pool();
  };
  BrickPool pool = hold(view.image, {}, {0, 1, 2, 3}, 4);
  pool = hold(coarser, std::move(pool), {0, 1, 2, 3, 4, 5}, 6);
  pool = hold(view.image, std::move(pool), {0, 1, 2, 3, 7}, 1);
  // Room for twelve: of the other level five are still there, the place of the sixth was needed.
  pool = hold(view.image, std::move(pool), {0, 1, 2, 3, 7, 8, 9}, 2);
  pool = hold(coarser, std::move(pool), {0, 1, 2, 3, 4, 5}, 1);
}

TEST(BrickPaging, WhatWasLookedUpTheLongestAgoLeavesFirst) {
  const OffscreenContext context;
  const VolumeView view = solid_view();
  const BrickLayout layout = brick_layout(*view.image, kCells);
  VoxelBricks bricks(view.image, layout, brick_ranges(*view.image), false);
  const std::vector<bool> needed(125, true);
  // Room for eight.
  const VoxelStorage storage{.memory = bricked_bytes(8, layout, view.image->type, 2048)};
  const auto uploads = [&](const std::vector<std::size_t>& wanted) {
    const std::uint64_t before = bricks.share().entered;
    bricks.hold(needed, wanted, storage);
    EXPECT_TRUE(bricks.share().complete());
    EXPECT_LE(bricks.bytes(), storage.memory);
    return bricks.share().entered - before;
  };
  EXPECT_EQ(uploads({0, 1, 2, 3}), 4U);
  EXPECT_EQ(uploads({10, 11, 12, 13}), 4U);
  EXPECT_EQ(uploads({2, 3}), 0U) << "still there";
  EXPECT_EQ(bricks.share().left, 0U);
  EXPECT_EQ(uploads({20, 21}), 2U) << "in place of 0 and 1";
  EXPECT_EQ(bricks.share().left, 2U);
  EXPECT_EQ(uploads({2, 3, 10, 11, 12, 13}), 0U);
  EXPECT_EQ(uploads({0, 1}), 2U) << "in place of 20 and 21";
  EXPECT_EQ(uploads({2, 3, 10, 11, 12, 13}), 0U);
  EXPECT_EQ(uploads({20, 30, 40, 50, 60, 70, 80, 90}), 8U) << "all of it";
  EXPECT_EQ(bricks.share().entered - bricks.share().left, 8U);
  // Another pool begins with none of them.
  bricks.hold(needed, {0, 1, 2}, {.memory = bricked_bytes(4, layout, view.image->type, 2048)});
  EXPECT_EQ(bricks.share().entered - bricks.share().left, 3U);
}

}  // namespace
}  // namespace palpate::test
