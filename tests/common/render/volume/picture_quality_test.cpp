// What savings of a frame budget are told to add to the error of a picture, and pictures that are refined.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/render/budget/frame_quality.h"
#include "common/render/gl/context.h"
#include "common/render/scene_renderer.h"
#include "common/render/volume/estimate/image_error.h"
#include "common/render/volume/estimate/saving_estimate.h"
#include "tests/common/render/lens/sample_lenses.h"
#include "tests/common/render/volume/sample_volumes.h"

namespace palpate::test {
namespace {

constexpr int kWidth = 140, kHeight = 112;

struct Difference {
  double rms = 0.0;  // 1 is full scale
  int worst = 0;
};

Difference difference(const Image& a, const Image& b) {
  Difference d;
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    const int off = std::abs(static_cast<int>(a.rgba[i]) - static_cast<int>(b.rgba[i]));
    d.worst = std::max(d.worst, off);
    sum += off * off;
  }
  d.rms = std::sqrt(sum / (0.75 * static_cast<double>(a.rgba.size()))) / 255.0;
  return d;
}

/// Blobs with much detail, and a lens that shows them by other colours.
SceneView scene_with_lens(std::optional<ScreenCircle> screen = {}) {
  SceneView view;
  view.volume = view_of(sampled_block(Index3(65), Vec3(2.0 / 64.0), ScalarType::kFloat32, marschner_lobb));
  view.volume->transfer = layered(view.volume->image->lowest, view.volume->image->highest);
  view.volume->shading = true;
  view.volume->samples_per_voxel = 2.0;
  Lens lens;
  lens.samples_per_voxel = 2.0;
  if (screen) {
    lens.screen = screen;
  } else {
    lens.shape = make_sphere({0.1, 0.0, 0.2}, 0.5);
  }
  lens.transfer = ColorTransfer({{0.3, {1.0F, 1.0F, 0.2F}, 0.0}, {0.7, {1.0F, 0.2F, 0.9F}, 0.1}});
  view.volume->lenses.push_back(lens);
  view.bounds = view.volume->image->bounds();
  view.camera = make_camera(view.bounds, {.azimuth = 25.0, .elevation = 20.0}, 1.25);
  view.show_axes = view.show_color_bar = false;
  return view;
}

Image picture_of(SceneRenderer& renderer, const SceneView& view, double resolution = 1.0) {
  renderer.draw(view, kWidth, kHeight, resolution);
  return renderer.read();
}

SceneView converged(SceneView view) {
  view.volume = converged_view(*view.volume);
  return view;
}

TEST(SavingEstimate, TellsTheErrorsOfPicturesWithThem) {
  const OffscreenContext context;
  SceneRenderer renderer;
  const SceneView view = scene_with_lens();
  EXPECT_FALSE(renderer.estimate_savings()) << "nothing was kept";
  renderer.keep_for_error(true);
  renderer.draw(view, kWidth, kHeight);
  renderer.keep_for_error(false);
  while (renderer.estimate_error()) {
  }
  EXPECT_FALSE(renderer.quality_errors());
  while (renderer.estimate_savings()) {
  }
  const std::optional<QualityErrors> errors = renderer.quality_errors();
  ASSERT_TRUE(errors);
  EXPECT_GT(errors->focus_share, 0.05);
  EXPECT_LT(errors->focus_share, 0.5);

  const Image best = picture_of(renderer, converged(view));
  for (const FrameQuality& quality :
       {FrameQuality{}, FrameQuality{.context = 0.25}, FrameQuality{.focus = 0.5},
        FrameQuality{.viewport = 0.5}, FrameQuality{.viewport = 0.25}, FrameQuality{.resolution = 0.7},
        FrameQuality{.resolution = 0.35}, FrameQuality{.resolution = 0.25},
        FrameQuality{.viewport = 0.25, .resolution = 0.25},
        FrameQuality{.context = 0.5, .focus = 0.5, .viewport = 0.5, .resolution = 0.5}}) {
    const double error =
        difference(picture_of(renderer, with_quality(view, quality), quality.resolution), best).rms;
    // A factor of two is what choosing needs.
    EXPECT_LT(errors->rms(quality), 2.0 * error + 0.5 / 255.0)
        << quality.context << " " << quality.focus << " " << quality.viewport << " " << quality.resolution;
    EXPECT_GT(errors->rms(quality), 0.5 * error - 0.5 / 255.0)
        << quality.context << " " << quality.focus << " " << quality.viewport << " " << quality.resolution;
  }
}

/// Where coarser voxels are drawn, as finer ones do not fit, the error knows what these hide. Against the same
/// picture of all voxels, pixel by pixel.
class CoarserVoxels : public testing::TestWithParam<int> {};

/// Specks of one voxel, which means hide; and others.
VolumeView volume_of_case(int number) {
  const auto specks = [](const Vec3& x) {
    const Vec3 g = glm::round(64.0 * (x + 1.0));
    const auto k = static_cast<int>(g.x + 37.0 * g.y + 101.0 * g.z);
    return k % 97 == 0 ? 1.0 : 0.02 * (1.0 + x.x);
  };
  const Formula formula = number % 3 == 0 ? Formula(specks) : number % 3 == 1 ? marschner_lobb : blobs;
  VolumeView view = view_of(sampled_block(
      Index3(129), Vec3(2.0 / 128.0), number % 2 == 0 ? ScalarType::kFloat32 : ScalarType::kUint8, formula));
  view.transfer = layered(view.image->lowest, view.image->highest);
  view.samples_per_voxel = 3.0;
  view.shading = number % 2 == 1;
  view.storage.brick_cells = 8;
  if (number >= 3) {
    Lens lens;
    lens.samples_per_voxel = 2.0;
    lens.shape = make_sphere({0.1, 0.0, 0.2}, 0.6);
    lens.transfer = ColorTransfer({{0.3, {1.0F, 1.0F, 0.2F}, 0.0}, {0.7, {1.0F, 0.2F, 0.9F}, 0.1}});
    view.lenses.push_back(lens);
  }
  if (number >= 4)
    view.cuts.push_back({.kept = {.outward = glm::normalize(Vec3(1.0, 0.3, 0.2)), .offset = 0.2}});
  return view;
}

TEST_P(CoarserVoxels, AreInTheError) {
  const OffscreenContext context;
  SceneView view;
  view.volume = volume_of_case(GetParam());
  view.bounds = view.volume->image->bounds();
  view.camera = make_camera(view.bounds, {.azimuth = 25.0, .elevation = 20.0}, 1.25,
                            GetParam() % 2 == 0 ? Projection::kPerspective : Projection::kOrthographic);
  view.show_axes = view.show_color_bar = false;
  SceneRenderer renderer;
  const Image best = picture_of(renderer, converged(view));

  view.volume->storage.memory = view.volume->image->byte_count() / 3;
  renderer.keep_for_error(true);
  const Image shown = picture_of(renderer, view);
  ASSERT_TRUE(renderer.coarser_voxels());
  while (renderer.estimate_error()) {
  }
  ASSERT_TRUE(renderer.image_error());
  const ImageError error = *renderer.image_error();
  EXPECT_TRUE(error.of_asked_voxels);
  const Difference truth = difference(shown, best);
  EXPECT_GT(truth.rms, 0.4 / 255.0) << "nothing to find";
  EXPECT_NEAR(error.rms, truth.rms, 4.0 * error.spread + 0.3 / 255.0);
  EXPECT_LE(error.worst, (truth.worst + 1) / 255.0);
}

INSTANTIATE_TEST_SUITE_P(Volumes, CoarserVoxels, testing::Range(0, 6));

// Memory that does not hold the voxels of one ray.
TEST(ImageError, SaysWhereFinestVoxelsDoNotFit) {
  const OffscreenContext context;
  SceneView view;
  view.volume = volume_of_case(0);
  view.volume->storage.brick_cells = 32;
  view.volume->storage.memory = view.volume->image->byte_count() / 60;
  view.bounds = view.volume->image->bounds();
  view.camera = make_camera(view.bounds, {.azimuth = 25.0, .elevation = 20.0}, 1.25);
  SceneRenderer renderer;
  renderer.keep_for_error(true);
  renderer.draw(view, kWidth, kHeight);
  ASSERT_TRUE(renderer.coarser_voxels());
  while (renderer.estimate_error()) {
  }
  ASSERT_TRUE(renderer.image_error());
  EXPECT_FALSE(renderer.image_error()->of_asked_voxels);
  EXPECT_GT(renderer.image_error()->pixels, 0U);
}

// Pixels that the lens changes are those that show some of it.
TEST(SavingEstimate, KnowsWhichPixelsShowALens) {
  const OffscreenContext context;
  for (const bool on_screen : {false, true}) {
    for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
      SceneRenderer renderer;
      SceneView view =
          scene_with_lens(on_screen ? std::optional(ScreenCircle{0.1, -0.15, 0.2}) : std::nullopt);
      view.camera = make_camera(view.bounds, {.azimuth = 25.0, .elevation = 20.0}, 1.25, projection);
      const Image with = picture_of(renderer, view);
      SceneView without = view;
      without.volume->lenses.clear();
      const Image plain = picture_of(renderer, without);
      const SceneFrame frame = scene_frame(view.bounds);
      const ViewTransform transform = view_transform(view.camera, frame, view.bounds, 1.25);
      const FrameBlock block =
          make_frame_block(view.camera, transform, palette_of(view.background), true, kWidth, kHeight);
      const PixelLattice all{.step = 1, .columns = kWidth, .rows = kHeight};
      const std::vector<bool> inside = lens_pixels(*view.volume, frame, block, all);
      int changed = 0, shown = 0;
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          const bool lens = inside[static_cast<std::size_t>((kHeight - 1 - y) * kWidth + x)];
          shown += lens ? 1 : 0;
          if (with.pixel(x, y) == plain.pixel(x, y)) continue;
          ++changed;
          EXPECT_TRUE(lens) << x << " " << y;
        }
      }
      EXPECT_GT(changed, shown / 2);
    }
  }
}

// What is linear comes back as it was, but within half a coarse pixel of the border.
TEST(SavingEstimate, CoarsensBilinearly) {
  Image image{61, 47, std::vector<std::uint8_t>(4 * 61 * 47, 255)};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x)
      image.rgba[static_cast<std::size_t>(4 * (y * image.width + x))] = static_cast<std::uint8_t>(3 * x + y);
  }
  for (const double share : {0.85, 0.5, 0.25}) {
    const int border = static_cast<int>(std::ceil(0.5 / share)) + 1;
    for (int y = border; y < image.height - border; ++y) {
      for (int x = border; x < image.width - border; ++x)
        EXPECT_NEAR(coarsened_pixel(image, nullptr, share, x, y)[0], 3 * x + y, 1e-9)
            << share << " " << x << " " << y;
    }
    EXPECT_EQ(coarsened_pixel(image, nullptr, share, 0, 0)[1], 255.0);
    EXPECT_EQ(coarsened_pixel(image, &image, share, 20, 20)[0], 0.0);
  }
}

// Whatever is given up at first, and with a context that is drawn by itself.
TEST(RefinedPicture, IsTheConvergedOne) {
  const OffscreenContext context;
  for (const int level : {0, 1}) {
    SceneRenderer renderer;
    SceneView view = scene_with_lens();
    view.volume->samples_per_voxel = 0.5;
    view.volume->context.level = level;
    const Image best = picture_of(renderer, converged(view));
    const Image coarse = picture_of(renderer, view);
    EXPECT_GT(difference(coarse, best).worst, 6) << level;
    int parts = 0;
    while (renderer.refine(1)) ++parts;
    EXPECT_GT(parts, 3) << "it can be interrupted";
    EXPECT_LT(difference(picture_of(renderer, view), best).rms, difference(coarse, best).rms) << level;
    const int most = most_doublings(*view.volume);
    EXPECT_EQ(most, 6 + level);
    while (renderer.refine(most)) {
    }
    EXPECT_LE(difference(picture_of(renderer, view), best).worst, 2) << level;
    EXPECT_FALSE(renderer.refine(most));

    // What is refined is forgotten where the volume is seen from elsewhere, and does not come back.
    SceneView turned = view;
    turned.camera = make_camera(view.bounds, {.azimuth = 60.0, .elevation = 20.0}, 1.25);
    const Image other = picture_of(renderer, turned);
    SceneRenderer fresh;
    EXPECT_EQ(difference(other, picture_of(fresh, turned)).worst, 0) << level;
    EXPECT_LE(difference(picture_of(renderer, view), coarse).worst, 1) << level;
  }
}

}  // namespace
}  // namespace palpate::test
