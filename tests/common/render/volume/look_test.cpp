// Silhouettes, context that fades before a lens, and shadows, on a ball.

#include <algorithm>

#include <gtest/gtest.h>

#include "common/render/volume/volume_picture.h"
#include "tests/common/render/volume/sample_volumes.h"

namespace palpate::test {
namespace {

constexpr int kSize = 80;

VolumeView view_of(const Formula& formula) {
  VolumeView view;
  view.image =
      make_volume_image(sampled_block(Index3(49), Vec3(1.0), ScalarType::kFloat32, formula), "s", "test");
  view.transfer = ColorTransfer({{0.45, {0.8F, 0.8F, 0.8F}, 0.0}, {0.55, {0.8F, 0.8F, 0.8F}, 0.6}});
  return view;
}

// 1 within a ball of two thirds of the half, falling to 0 over a few voxels.
VolumeView ball() {
  return view_of([](const Vec3& x) { return std::clamp(0.5 + 5.0 * (0.66 - glm::length(x)), 0.0, 1.0); });
}

// From before.
Camera camera_of(const VolumeView& view) {
  return make_camera(view.image->bounds(), {}, 1.0, Projection::kOrthographic);
}

double highest_opacity_of_row(const FloatImage& image, int y) {
  double most = 0.0;
  for (int x = 0; x < image.width; ++x) most = std::max(most, image.at(x, y)[3]);
  return most;
}

TEST(VolumeLooks, OfABallInLinesItsOutlineIsLeft) {
  VolumePicture picture(kSize, kSize);
  VolumeView view = ball();
  const Camera camera = camera_of(view);
  EXPECT_GT(picture.draw(view, camera).at(kSize / 2, kSize / 2)[3], 0.98);
  view.illustrated = true;
  for (const bool shading : {true, false}) {
    view.shading = shading;
    const FloatImage lines = picture.draw(view, camera);
    EXPECT_LT(lines.at(kSize / 2, kSize / 2)[3], 0.1) << shading;
    EXPECT_GT(highest_opacity_of_row(lines, kSize / 2), 0.6) << shading;
  }
}

TEST(VolumeLooks, WhatLiesBeforeALensFades) {
  VolumePicture picture(kSize, kSize);
  VolumeView view = ball();
  view.shading = false;
  const Camera camera = camera_of(view);
  Lens lens{.shape = make_sphere(Vec3(0.0), 6.0), .screen = {}, .transfer = {}, .regions = {}};
  lens.shading = false;
  lens.transfer = ColorTransfer({{0.0, {1.0F, 0.0F, 0.0F}, 0.9}});
  view.lenses = {lens};
  const Rgba hidden = picture.draw(view, camera).at(kSize / 2, kSize / 2);
  EXPECT_LT(hidden[0] - hidden[2], 0.02) << "grey matter stands before it";
  view.context_fade = 1.0;
  const FloatImage faded = picture.draw(view, camera);
  const Rgba seen = faded.at(kSize / 2, kSize / 2);
  EXPECT_GT(seen[0] - seen[2], 0.8);
  // Beside the lens nothing changes.
  EXPECT_GT(faded.at(kSize / 2 + kSize / 8, kSize / 2)[3], 0.98);
  view.context.viewport = 0.5;  // the context as a picture of its own
  const Rgba apart = picture.draw(view, camera).at(kSize / 2, kSize / 2);
  EXPECT_GT(apart[0] - apart[2], 0.7);
}

// A ball darkens its own far side: the light comes from above the left shoulder.
TEST(VolumeLooks, MatterCastsItsShadowAwayFromTheLight) {
  VolumePicture picture(kSize, kSize);
  VolumeView view = ball();
  const Camera camera = camera_of(view);
  const FloatImage bright = picture.draw(view, camera);
  view.shadows = true;
  const FloatImage shadowed = picture.draw(view, camera);
  // Rows run from the bottom: what faces the light, up and to the left, stays; the far side darkens.
  const int off = kSize / 9;
  const auto share = [&](int x, int y) { return shadowed.at(x, y)[1] / bright.at(x, y)[1]; };
  const double lit = share(kSize / 2 - off, kSize / 2 + off), dark = share(kSize / 2 + off, kSize / 2 - off);
  EXPECT_GT(lit, 0.995);
  EXPECT_LT(dark, 0.98);
  EXPECT_NEAR(shadowed.at(kSize / 2, kSize / 2)[3], bright.at(kSize / 2, kSize / 2)[3], 0.02)
      << "opacity stays";
}

}  // namespace
}  // namespace palpate::test
