// The window's pictures of a volume: they refine by themselves while the view stands still.
#include "common/window/picture/live_picture.h"

#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

#include "common/render/gl/context.h"
#include "common/render/volume/estimate/image_error.h"
#include "tests/common/render/lens/sample_lenses.h"

namespace palpate::test {
namespace {

constexpr int kSize = 96;
constexpr int kMostPictures = 100;

int largest_difference(const Image& a, const Image& b) {
  int most = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i)
    most = std::max(most, std::abs(static_cast<int>(a.rgba[i]) - static_cast<int>(b.rgba[i])));
  return most;
}

SceneView scene_of(VolumeView volume) {
  SceneView view;
  view.bounds = volume.image->bounds();
  view.camera = camera_of(volume);
  view.volume = std::move(volume);
  return view;
}

TEST(LivePicture, OfBricksRefinesUntilItIsThatOfTheWhole) {
  const OffscreenContext context;
  VolumeView volume = view_of(sampled_block(Index3(161), Vec3(0.01), ScalarType::kFloat32, blobs));
  volume.transfer = spread(ColorTransfer({{0.0, {0.1F, 0.2F, 0.9F}, 0.02}, {1.0, {1.0F, 0.6F, 0.2F}, 0.1}}),
                           volume.image->lowest, volume.image->highest);
  volume.table_entries = 64;
  SceneView view = scene_of(volume);
  LivePicture whole(100.0);
  whole.draw(view, kSize, kSize, {.seconds = 1.0});
  EXPECT_TRUE(whole.complete());
  EXPECT_EQ(whole.figures().bricks.all, 0U);
  const Image expected = whole.read();

  view.volume->storage.brick_cells = 32;
  LivePicture paged(100.0);
  paged.draw(view, kSize, kSize, {.seconds = 1.0});
  EXPECT_FALSE(paged.complete());
  EXPECT_EQ(paged.figures().bricks.all, 125U);
  EXPECT_LT(paged.figures().bricks.held, paged.figures().bricks.wanted);
  int pictures = 1;
  for (; pictures < kMostPictures && !paged.complete(); ++pictures)
    paged.draw(view, kSize, kSize, {.seconds = 1.0 + 0.1 * pictures});
  EXPECT_TRUE(paged.complete());
  EXPECT_GT(pictures, 1);
  EXPECT_LE(largest_difference(paged.read(), expected), 1);

  // What is hidden is waited for by nobody.
  LivePicture hidden(100.0);
  hidden.draw(view, kSize, kSize, {.seconds = 1.0});
  EXPECT_FALSE(hidden.complete());
  view.volume->shown = false;
  hidden.draw(view, kSize, kSize, {.seconds = 2.0});
  EXPECT_TRUE(hidden.complete());
}

/// Until nothing is left to be done, as a window at rest does. @return the pictures that it took.
int rest(LivePicture& picture, const SceneView& view, double& seconds) {
  int calls = 0;
  do {
    picture.draw(view, kSize, kSize, {.seconds = seconds += 0.1, .interrupted = [] { return false; }});
  } while (!picture.complete() && ++calls < 1000);
  return calls;
}

TEST(LivePicture, AtRestConvergesAndKnowsTheErrorOfWhatMoves) {
  const OffscreenContext context;
  for (const StereoMode mode : {StereoMode::kNone, StereoMode::kSideBySide}) {
    const bool two_eyes = mode != StereoMode::kNone;
    VolumeView volume = sampled_view(marschner_lobb, ScalarType::kFloat32, 41);
    volume.shading = true;
    volume.samples_per_voxel = 0.5;
    volume.table_entries = 64;
    SceneView view = scene_of(volume);
    view.stereo.mode = mode;
    LivePicture picture(1e4);
    double seconds = 1.0;
    const auto move = [&] { picture.draw(view, kSize, kSize, {.seconds = seconds += 0.1, .moving = true}); };
    move();
    EXPECT_FALSE(picture.figures().expected_error) << "nothing was measured";
    const Image before = picture.read();
    EXPECT_LT(rest(picture, view, seconds), 900);
    ASSERT_TRUE(picture.figures().error);
    SceneView best = view;
    best.volume = converged_view(volume);
    LivePicture converged(1e4);
    converged.draw(best, kSize, kSize, {.seconds = 1.0});
    const int left = largest_difference(picture.read(), converged.read());
    const int first = largest_difference(before, converged.read());
    EXPECT_GT(first, 8);
    if (two_eyes) {
      EXPECT_LT(left, first);  // as far as a slow machine comes
    } else {
      EXPECT_LE(left, 1);
      EXPECT_LT(255.0 * picture.figures().error->worst, 1.5);
    }

    view.camera.focal_point.x += 0.01;
    move();
    ASSERT_TRUE(picture.figures().expected_error);
    EXPECT_FALSE(picture.figures().error);
    EXPECT_GT(*picture.figures().expected_error, 1e-3);
    EXPECT_LT(*picture.figures().expected_error, 0.1);
  }
}

// All detail of a large volume takes long: the first picture is one of little.
TEST(LivePicture, OfALargeVolumeIsCoarseFirstAndWholeNext) {
  const OffscreenContext context;
  VolumeView volume = view_of(sampled_block(Index3(257), Vec3(0.01), ScalarType::kUint8, blobs));
  volume.table_entries = 64;
  SceneView view = scene_of(volume);
  LivePicture picture(100.0);
  picture.draw(view, kSize, kSize, {.seconds = 1.0});
  EXPECT_FALSE(picture.complete());
  EXPECT_NE(picture.figures().quality, FrameQuality{});
  const Image first = picture.read();
  picture.draw(view, kSize, kSize, {.seconds = 2.0});
  EXPECT_TRUE(picture.complete());
  EXPECT_EQ(picture.figures().quality, FrameQuality{});
  EXPECT_GT(largest_difference(first, picture.read()), 8);
}

// Who comes up while the full picture of a volume is drawn waits for a part of it alone; what was shown stays.
TEST(LivePicture, IsLeftWhereInputWaits) {
  const OffscreenContext context;
  VolumeView volume = sampled_view(marschner_lobb);
  volume.samples_per_voxel = 0.5;
  SceneView view = scene_of(volume);
  LivePicture picture(1e4);
  picture.draw(view, kSize, kSize, {.seconds = 1.0});
  const Image before = picture.read();
  turn(view.camera, 0.5, 0.0);
  const Image turned = [&] {
    LivePicture other(1e4);
    other.draw(view, kSize, kSize, {.seconds = 1.0});
    return other.read();
  }();
  ASSERT_GT(largest_difference(before, turned), 20);
  for (int parts = 0; parts < 3; ++parts) {
    int asked = 0;
    picture.draw(view, kSize, kSize, {.seconds = 2.0, .stop = [&] { return asked++ == parts; }});
    EXPECT_EQ(asked, parts + 1) << "it is asked between parts, and then no more";
    EXPECT_FALSE(picture.complete());
    EXPECT_EQ(largest_difference(picture.read(), before), 0) << "the last one stays";
  }
  // In parts that nobody stops, and at once after one that was: the same picture.
  int asked = 0;
  picture.draw(view, kSize, kSize, {.seconds = 3.0, .stop = [&] { return ++asked < 0; }});
  EXPECT_GE(asked, 5);
  EXPECT_TRUE(picture.complete());
  EXPECT_EQ(largest_difference(picture.read(), turned), 0);
  turn(view.camera, -0.5, 0.0);
  picture.draw(view, kSize, kSize, {.seconds = 4.0});
  EXPECT_EQ(largest_difference(picture.read(), before), 0);
}

// Something comes up while it refines: what was begun is left, and taken up again.
TEST(LivePicture, LetsItselfBeInterrupted) {
  const OffscreenContext context;
  VolumeView volume = sampled_view(marschner_lobb);
  volume.samples_per_voxel = 0.5;
  const SceneView view = scene_of(volume);
  LivePicture picture(1e4);
  for (int i = 0; i < 12; ++i) {
    picture.draw(view, kSize, kSize, {.seconds = 1.0 + 0.1 * i, .interrupted = [] { return true; }});
    if (i < 4) {
      EXPECT_FALSE(picture.complete()) << i;
    }
  }
  double seconds = 3.0;
  (void)rest(picture, view, seconds);
  EXPECT_TRUE(picture.complete());
  EXPECT_LT(255.0 * picture.figures().error->worst, 1.5);
}

}  // namespace
}  // namespace palpate::test
