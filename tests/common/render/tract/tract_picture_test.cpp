// Pictures of tracts: what is seen, that a picture that is drawn bit by bit is the one that is drawn at once,
// and how much of what lies behind transparent tracts shines through.

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/render/gl/context.h"
#include "common/render/scene_renderer.h"
#include "common/render/tensor/tensor_voxels.h"
#include "tests/common/render/picture_checks.h"
#include "tests/common/render/tensor/sample_tensors.h"

namespace palpate::test {
namespace {

/// Straight lines through [-1, 1]^3, front to back in any order.
std::shared_ptr<const TractBundle> random_bundle(std::size_t count, int points) {
  std::mt19937 random{3};
  std::uniform_real_distribution<float> place{-0.9F, 0.9F};
  auto lines = std::make_shared<Tractogram>();
  for (std::size_t l = 0; l < count; ++l) {
    const Vec3f a{place(random), place(random), place(random)},
        b{place(random), place(random), place(random)};
    for (int i = 0; i < points; ++i) {
      const float u = static_cast<float>(i) / static_cast<float>(points - 1);
      lines->points.push_back(a + u * (b - a));
    }
    lines->starts.push_back(lines->points.size());
  }
  return make_tract_bundle(lines);
}

/// A sheet of lines along x at y = 0, from z = -1 to z = 1.
std::shared_ptr<const TractBundle> sheet() {
  auto lines = std::make_shared<Tractogram>();
  for (int i = 0; i <= 400; ++i) {
    const float z = -1.0F + static_cast<float>(i) / 200.0F;
    lines->points.emplace_back(-1.0F, 0.0F, z);
    lines->points.emplace_back(1.0F, 0.0F, z);
    lines->starts.push_back(lines->points.size());
  }
  return make_tract_bundle(lines);
}

/// A grey veil over everything.
VolumeView fog() {
  const auto voxels = sampled_tensors(centred_lattice({9, 9, 9}, Mat3(0.25)), [](const Vec3&) {
    return linear_tensor({1.0, 0.0, 0.0});
  });
  VolumeView volume;
  volume.image = make_anisotropy_volume(voxels);
  volume.transfer = ColorTransfer({{0.0, Vec3f(0.5F), 0.03}});
  volume.shading = false;
  return volume;
}

TEST(TractPicture, ShowsLinesInTheColourOfTheirDirection) {
  SceneView view = front_view({});
  view.tracts = TractView{.bundle = sheet(), .width = 20.0, .depth_cue = false};
  const auto pixel = at(render_image(view, kSize, kSize).image, 0.1, 0.2);
  EXPECT_GT(pixel[0], 120);
  EXPECT_LT(pixel[1], 60);
  EXPECT_LT(pixel[2], 60);
}

// Lines of many pieces, a bit in each picture, as in a window with a probe: in the end the same picture, bit
// by bit, since every piece is drawn with depth.
TEST(TractPicture, IsTheSameDrawnBitByBit) {
  const auto bundle = random_bundle(900, 400);
  ASSERT_GT(bundle->pieces.size(), 4U);
  SceneView view = front_view({});
  view.tracts = TractView{.bundle = bundle, .width = 6.0};
  view.probe.emplace();
  const OffscreenContext context;
  SceneRenderer whole, bits;
  whole.draw(view, kSize, kSize);
  EXPECT_TRUE(whole.complete());
  const Image expected = whole.read();
  bits.draw(view, kSize, kSize, 1.0, 0.0);
  EXPECT_FALSE(bits.complete());
  const Image first = bits.read();
  EXPECT_GT(mean_difference(first, expected), 0.5);
  std::size_t pictures = 1;
  for (; !bits.complete() && pictures < 100; ++pictures) bits.draw(view, kSize, kSize, 1.0, 0.0);
  EXPECT_EQ(pictures, bundle->pieces.size()) << "at least one piece a picture, and no more in no time";
  EXPECT_EQ(bits.read().rgba, expected.rgba);
  // Another view starts again.
  view.camera = make_camera(view.bounds, {.azimuth = 40.0}, 1.0);
  bits.draw(view, kSize, kSize, 1.0, 0.0);
  EXPECT_FALSE(bits.complete());
}

TEST(TractPicture, WithoutALimitAllIsDrawnAtOnce) {
  SceneView view = front_view({});
  view.tracts = TractView{.bundle = random_bundle(900, 400)};
  const OffscreenContext context;
  SceneRenderer renderer;
  renderer.draw(view, kSize, kSize);
  EXPECT_TRUE(renderer.complete());
  EXPECT_EQ(renderer.tract_share().drawn, 900U);
  EXPECT_EQ(renderer.tract_share().all, 900U);
}

/// A picture in bits, each of one piece of the tracts at least, until it is complete.
Image in_bits(const SceneView& view) {
  SceneRenderer bits;
  std::size_t shown = 0;
  int pictures = 0;
  do {
    bits.draw(view, kSize, kSize, 1.0, 0.0);
    EXPECT_GE(bits.tract_share().drawn, shown) << "never fewer than before";
    EXPECT_GT(bits.tract_share().drawn, 0U);
    shown = bits.tract_share().drawn;
  } while (!bits.complete() && ++pictures < 100);
  EXPECT_GT(pictures, 4);
  EXPECT_EQ(shown, bits.tract_share().all);
  return bits.read();
}

// A volume that shines over the tracts, transparency, no probe: in the end the picture without a limit.
TEST(TractPicture, IsTheSameInBitsWithAVolumeAndTransparent) {
  const OffscreenContext context;
  SceneView view = front_view({});
  view.tracts = TractView{.bundle = random_bundle(900, 400), .width = 6.0};
  const auto whole = [&] {
    SceneRenderer renderer;
    renderer.draw(view, kSize, kSize);
    return renderer.read();
  };
  const Image bare = whole();
  EXPECT_EQ(in_bits(view).rgba, bare.rgba);
  view.volume = fog();
  const Image veiled = whole();
  EXPECT_GT(mean_difference(veiled, bare), 1.0);
  EXPECT_EQ(in_bits(view).rgba, veiled.rgba);
  view.tracts->opacity = 0.3;
  EXPECT_GT(mean_difference(whole(), veiled), 1.0);
  EXPECT_EQ(in_bits(view).rgba, whole().rgba);
  view.volume.reset();
  EXPECT_EQ(in_bits(view).rgba, whole().rgba);
}

// A hand that moves the view does not wait for the time to be over.
TEST(TractPicture, TractsEndWhenAskedTo) {
  const OffscreenContext context;
  SceneView view = front_view({});
  view.tracts = TractView{.bundle = random_bundle(900, 400), .width = 6.0};
  constexpr double kLong = 1e9;  // [ms]
  SceneRenderer renderer;
  int asked = 0;
  renderer.draw(view, kSize, kSize, 1.0, kLong, [&] { return ++asked == 1; });
  EXPECT_EQ(asked, 1);
  EXPECT_FALSE(renderer.complete());
  renderer.draw(view, kSize, kSize, 1.0, kLong, [] { return false; });
  EXPECT_TRUE(renderer.complete());
}

// A part of transparent tracts hides as much of what lies behind as all of them do, by its higher opacity:
// the mean of all pixels differs by less than a tenth of what tracts change of it.
TEST(TractPicture, APartOfTransparentTractsLooksLikeAll) {
  const OffscreenContext context;
  SceneView view = front_view({});
  view.tracts =
      TractView{.bundle = random_bundle(2400, 400), .width = 6.0, .opacity = 0.05, .depth_cue = false};
  const auto mean = [](const SceneRenderer& renderer) {
    const Image picture = renderer.read();
    double sum = 0.0;
    for (const std::uint8_t byte : picture.rgba) sum += byte;
    return sum / static_cast<double>(picture.rgba.size());
  };
  SceneRenderer all, part;
  all.draw(view, kSize, kSize);
  part.draw(view, kSize, kSize, 1.0, 0.0);
  while (part.tract_share().drawn < 500) part.draw(view, kSize, kSize, 1.0, 0.0);
  ASSERT_FALSE(part.complete());
  view.tracts.reset();
  SceneRenderer none;
  none.draw(view, kSize, kSize);
  EXPECT_NEAR(mean(part) - mean(none), mean(all) - mean(none), 0.1 * (mean(all) - mean(none)));
}

// Of a sheet with opacity a the share a covers what lies behind. The mean over 120 x 120 pixels of 4 samples
// is within 5 sqrt(a (1 - a) / 57600) of it; lines overlap here, which covers more: each sample by one line
// at least, by two in places. So a sheet of single lines, side by side.
TEST(TractPicture, OpacityIsTheShareThatTheyCover) {
  auto lines = std::make_shared<Tractogram>();
  lines->points = {Vec3f(-1.0F, 0.0F, 0.0F), Vec3f(1.0F, 0.0F, 0.0F)};
  lines->starts = {0, 2};
  SceneView view = front_view({});
  view.tracts = TractView{.bundle = make_tract_bundle(lines), .width = 400.0, .depth_cue = false};
  const auto mean = [&](double opacity) {
    view.tracts->opacity = opacity;
    const Image picture = render_image(view, kSize, kSize).image;
    double sum = 0.0;
    int count = 0;
    for (int y = 90; y < 110; ++y) {
      for (int x = 40; x < 160; ++x, ++count) sum += picture.pixel(x, y)[0];
    }
    return sum / count;
  };
  const double covered = mean(1.0), bare = [&] {
    SceneView empty = view;
    empty.tracts.reset();
    return static_cast<double>(render_image(empty, kSize, kSize).image.pixel(100, 100)[0]);
  }();
  for (const double opacity : {0.25, 0.5, 0.8}) {
    const double share = (mean(opacity) - bare) / (covered - bare);
    EXPECT_NEAR(share, opacity, 0.06) << opacity;  // samples are mixed as sRGB, and rounded to bytes
  }
}

}  // namespace
}  // namespace palpate::test
