// The window's pictures of a volume in bricks: they refine by themselves while the view stands still.
#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

#include "common/app/window/live_picture.h"
#include "common/render/gl/context.h"
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

TEST(LiveBricks, RefineUntilThePictureIsThatOfTheWhole) {
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

}  // namespace
}  // namespace palpate::test
