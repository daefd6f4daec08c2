// What is drawn on the planes of a volume, held against the formula of its values.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "common/render/render_image.h"
#include "tests/common/render/volume/sample_volumes.h"

namespace palpate::test {
namespace {

constexpr int kSize = 200;

/// A volume of `formula` over [-1, 1]^3, none of which is seen but on the plane z = 0.
SceneView scene_of(const Formula& formula) {
  SceneView scene;
  scene.volume = sampled_view(formula);
  scene.volume->transfer = ColorTransfer({{0.0, {1.0F, 1.0F, 1.0F}, 0.0}});
  scene.volume->cuts = {{.kept = {{0.0, 0.0, 1.0}, 0.0}, .on = true}};
  scene.volume->planes.shown = true;
  scene.bounds = scene.volume->image->bounds();
  scene.show_outline = scene.show_axes = scene.show_color_bar = false;
  scene.camera = make_camera(scene.bounds, {.azimuth = 0.0, .elevation = 70.0}, 1.0);
  return scene;
}

std::array<int, 4> pixel_of(const Image& image, const Camera& camera, const Vec3& x) {
  const Vec3 at = project(camera, x, kSize, kSize);
  return image.pixel(static_cast<int>(std::floor(at.x)), static_cast<int>(std::floor(at.y)));
}

TEST(PlaneImage, GreyIsTheValueInItsWindow) {
  SceneView scene = scene_of([](const Vec3& x) { return 0.5 + 0.3 * x.x + 0.1 * x.y; });
  scene.volume->planes.window = ValueWindow{0.5, 0.6};
  const Image image = render_image(scene, kSize, kSize).image;
  for (const Vec3 x :
       {Vec3(-0.8, 0.1, 0.0), Vec3(-0.3, -0.7, 0.0), Vec3(0.2, 0.6, 0.0), Vec3(0.9, 0.9, 0.0)}) {
    const double value = 0.5 + 0.3 * x.x + 0.1 * x.y;
    const double grey = 255.0 * std::clamp((value - 0.35) / 0.5, 0.0, 1.0);
    constexpr double kHalfPixel = 2.5;  // the value half a pixel away, and rounding
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(pixel_of(image, scene.camera, x)[static_cast<std::size_t>(c)], grey, kHalfPixel) << x.x;
  }
}

// Bricks that planes meet are held, though nothing of the volume is seen.
TEST(PlaneImage, IsTheSameFromVoxelsInBricks) {
  SceneView scene = scene_of(blobs);
  scene.volume->cuts[0].kept.outward = glm::normalize(Vec3(0.2, -0.3, 1.0));
  scene.volume->planes.contours = {0.4};
  const Image whole = render_image(scene, kSize, kSize).image;
  scene.volume->storage.brick_cells = 8;
  const RenderedImage bricked = render_image(scene, kSize, kSize);
  int worst = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      for (std::size_t c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(whole.pixel(x, y)[c] - bricked.image.pixel(x, y)[c]));
    }
  }
  // Graphics cards interpolate voxels with eight bits of their places, which differ in bricks: edges of lines move.
  EXPECT_LE(worst, 6) << "values and lines, both drawn over an edge in one pixel";
  const auto pool = std::find_if(bricked.gpu.begin(), bricked.gpu.end(), [](const GpuObject& object) {
    return object.what.starts_with("voxels in bricks");
  });
  ASSERT_NE(pool, bricked.gpu.end());
  EXPECT_LT(pool->bytes, 33U * 33U * 33U * 4U) << "others are not held";
}

// The plane of another cut ends it, and one that does not cut shows its picture, too.
TEST(PlaneImage, EndsAtOtherCutsAndNeedNotCut) {
  SceneView scene = scene_of([](const Vec3&) { return 1.0; });
  scene.volume->planes.window = ValueWindow{1.0, 0.5};
  scene.volume->cuts[0].on = false;
  scene.volume->cuts.push_back({.kept = {{1.0, 0.0, 0.0}, 0.2}, .on = true});
  const Image image = render_image(scene, kSize, kSize).image;
  EXPECT_GT(pixel_of(image, scene.camera, {0.1, -0.5, 0.0})[0], 250);
  EXPECT_LT(pixel_of(image, scene.camera, {0.35, -0.5, 0.0})[0], 100);
  scene.volume->cuts[1].on = false;
  EXPECT_GT(pixel_of(render_image(scene, kSize, kSize).image, scene.camera, {0.35, -0.5, 0.0})[0], 250);
}

TEST(PlaneImage, LinesRunWhereTheValueIs) {
  SceneView scene = scene_of([](const Vec3& x) { return glm::length(x); });
  scene.volume->planes.window = ValueWindow{4.0, 2.0};  // dark
  scene.volume->planes.contours = {0.6};
  const Image image = render_image(scene, kSize, kSize).image;
  for (int i = 0; i < 24; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + 0.5) / 24.0;
    const Vec3 out(std::cos(angle), std::sin(angle), 0.0);
    EXPECT_GT(pixel_of(image, scene.camera, 0.6 * out)[2], 120) << i;  // half a pixel off, half covered
    EXPECT_LT(pixel_of(image, scene.camera, 0.52 * out)[2], 60) << i;
    EXPECT_LT(pixel_of(image, scene.camera, 0.68 * out)[2], 60) << i;
  }
}

TEST(PlaneImage, ShowsALensInItsColoursAndNothingWhereItCuts) {
  SceneView scene = scene_of([](const Vec3& x) { return 0.5 + 0.4 * x.x; });
  scene.volume->planes.window = ValueWindow{1.0, 0.5};
  Lens lens;
  lens.shape = make_sphere(Vec3(0.0), 0.4);
  // Half opaque red a length of its own: half of the grey is left.
  lens.transfer = ColorTransfer({{0.0, {1.0F, 0.0F, 0.0F}, 0.5}});
  scene.volume->lenses = {lens};
  const auto inside = pixel_of(render_image(scene, kSize, kSize).image, scene.camera, Vec3(0.0));
  constexpr double kTable = 3.0;  // 16 bits of the table's longest stretch, and half a pixel
  EXPECT_NEAR(inside[0], 0.5 * 255.0 + 0.5 * 127.5, kTable);
  EXPECT_NEAR(inside[1], 0.5 * 127.5, kTable);
  scene.volume->lenses[0].cut = true;
  scene.volume->lenses[0].transfer.reset();
  const Image cut = render_image(scene, kSize, kSize).image;
  EXPECT_LT(pixel_of(cut, scene.camera, Vec3(0.0))[0], 60);
  EXPECT_GT(pixel_of(cut, scene.camera, Vec3(0.6, 0.0, 0.0))[0], 150);
}

// The plane through the middle with a normal along a diagonal meets a cube in a regular hexagon.
TEST(PlaneImage, TheSectionOfACubeAcrossItsDiagonalIsAHexagon) {
  VolumeView view = sampled_view(blobs);
  const double third = std::sqrt(1.0 / 3.0);
  view.cuts = {{.kept = {Vec3(third), 0.0}, .on = true}};
  const std::vector<Vec3> corners = shown_section(view, 0);
  ASSERT_EQ(corners.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(glm::distance(corners[i], corners[(i + 1) % 6]), std::sqrt(2.0), 1e-6);
    EXPECT_NEAR(glm::length(corners[i]), std::sqrt(2.0), 1e-6);
  }
  view.cuts[0].kept.offset = 2.0;
  EXPECT_TRUE(shown_section(view, 0).empty());
}

}  // namespace
}  // namespace palpate::test
