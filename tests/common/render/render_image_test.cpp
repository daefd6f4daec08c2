#include "common/render/render_image.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/render/gl/context.h"
#include "common/render/scene_renderer.h"
#include "tests/common/render/picture_checks.h"
#include "tests/common/render/sample_probe.h"
#include "tests/common/render/sample_scenes.h"
#include "tests/common/render/volume/sample_volumes.h"
#include "tests/support/lab_color.h"

namespace palpate {
namespace {

TEST(RenderImage, LinesLieWhereProjectionPutsThem) {
  SceneView view = test::front_view({test::polyline({{-0.8, 0.0, 0.5}, {0.8, 0.0, 0.5}}),
                                     test::polyline({{-0.3, 0.0, -0.9}, {-0.3, 0.0, 0.1}})});
  view.style.color_by = ColorBy::kDirection;
  const Image image = render_image(view, test::kSize, test::kSize).image;
  ASSERT_EQ(image.rgba.size(), 4U * test::kSize * test::kSize);
  for (const double x : {-0.75, 0.0, 0.75}) {
    const auto along_x = test::at(image, x, 0.5);
    EXPECT_GT(along_x[0], 120) << x;
    EXPECT_GT(along_x[0], along_x[1] + 60) << x;
    EXPECT_GT(along_x[0], along_x[2] + 60) << x;
    EXPECT_TRUE(test::is_background(test::at(image, x, 0.62))) << x;
    EXPECT_TRUE(test::is_background(test::at(image, x, 0.38))) << x;
  }
  const auto along_z = test::at(image, -0.3, -0.5);
  EXPECT_GT(along_z[2], along_z[0] + 60);
  EXPECT_TRUE(test::is_background(test::at(image, 0.9, 0.5)));
  EXPECT_TRUE(test::is_background(test::at(image, -0.3, 0.3)));
}

TEST(RenderImage, WidthIsInThousandthsOfTheHeight) {
  SceneView view = test::front_view({test::polyline({{-0.8, 0.0, 0.0}, {0.8, 0.0, 0.0}})});
  view.style.halo = false;
  view.style.color_by = ColorBy::kUniform;
  view.style.width = 50.0;  // 10 pixels
  const Image image = render_image(view, test::kSize, test::kSize).image;
  int lit = 0;
  for (int y = 0; y < test::kSize; ++y) lit += test::is_background(image.pixel(test::kSize / 2, y)) ? 0 : 1;
  EXPECT_GE(lit, 9);
  EXPECT_LE(lit, 11);
}

TEST(RenderImage, NearerLineHidesTheFartherOne) {
  // Looking along +y: smaller y is nearer. The far line comes last in the list.
  SceneView view = test::front_view({test::polyline({{-0.5, -0.5, 0.0}, {0.5, -0.5, 0.0}}),
                                     test::polyline({{0.0, 0.5, -0.5}, {0.0, 0.5, 0.5}})});
  view.style.color_by = ColorBy::kDirection;
  for (const Projection projection : {Projection::kOrthographic, Projection::kPerspective}) {
    view.camera.projection = projection;
    const Image image = render_image(view, test::kSize, test::kSize).image;
    const auto middle = test::at(image, 0.0, 0.0);
    EXPECT_GT(middle[0], middle[2] + 60);
  }
}

TEST(RenderImage, HaloCutsTheLineBehind) {
  SceneView view = test::front_view({test::polyline({{-0.5, -0.5, 0.0}, {0.5, -0.5, 0.0}}),
                                     test::polyline({{0.0, 0.5, -0.5}, {0.0, 0.5, 0.5}})});
  view.style.color_by = ColorBy::kDirection;
  // Just outside the edge of the near line (3 pixels from its middle), upon the far one.
  const double beside = 4.0 * 2.44 / test::kSize;
  EXPECT_TRUE(test::is_background(test::at(render_image(view, test::kSize, test::kSize).image, 0.0, beside)));
  view.style.halo = false;
  EXPECT_FALSE(
      test::is_background(test::at(render_image(view, test::kSize, test::kSize).image, 0.0, beside)));
}

TEST(RenderImage, ColoursFollowTheMap) {
  Line line;
  for (int i = 0; i <= 10; ++i) line.points.push_back({{-0.9 + 0.18 * i, 0.0, 0.0}, 0.0, 0.0, 3.0 + i, 1.0});
  SceneView view = test::front_view({line});
  view.style.range = ValueRange{3.0, 13.0};
  view.style.width = 60.0;
  const Image image = render_image(view, test::kSize, test::kSize).image;
  // Light changes brightness, not hue: compare hue angles in CIELAB.
  for (const double t : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    const auto pixel = test::at(image, -0.9 + 1.8 * t, 0.0);
    const Vec3 found = test::lab_from_srgb(Vec3(pixel[0], pixel[1], pixel[2]) / 255.0);
    const Vec3 expected = test::lab_from_srgb(Vec3(map_color(ColorMap::kSequential, t)));
    const double turned =
        std::remainder(std::atan2(found.z, found.y) - std::atan2(expected.z, expected.y), 6.283185307);
    EXPECT_LT(std::abs(turned), 0.25) << t;
  }
}

TEST(RenderImage, ValuesThatAreNotNumbersAreGrey) {
  SceneView view = test::front_view({test::polyline({{-0.8, 0.0, 0.0}, {0.8, 0.0, 0.0}}, std::nan(""))});
  const Image image = render_image(view, test::kSize, test::kSize).image;
  const auto c = test::at(image, 0.0, 0.0);
  EXPECT_FALSE(test::is_background(c));
  EXPECT_NEAR(c[0], c[1], 6);
  EXPECT_NEAR(c[1], c[2], 6);
}

TEST(RenderImage, DimmedLinesTakeOnTheBackground) {
  SceneView view = test::front_view({test::polyline({{-0.8, 0.0, 0.0}, {0.8, 0.0, 0.0}})});
  view.style.color_by = ColorBy::kUniform;
  const auto brightness = [&](double dimming) {
    view.style.dimming = dimming;
    return test::at(render_image(view, test::kSize, test::kSize).image, 0.0, 0.0)[0];
  };
  const int bright = brightness(0.0), half = brightness(0.5), none = brightness(1.0);
  EXPECT_NEAR(half, 0.5 * (bright + none), 2.0);
  EXPECT_TRUE(test::is_background({none, none, none, 255}));
}

TEST(RenderImage, LineTowardTheEyeIsADot) {
  SceneView view = test::front_view({test::polyline({{0.2, -0.9, 0.3}, {0.2, 0.9, 0.3}})});
  view.style.color_by = ColorBy::kUniform;
  const Image image = render_image(view, test::kSize, test::kSize).image;
  int lit = 0;
  for (int y = 0; y < test::kSize; ++y) {
    for (int x = 0; x < test::kSize; ++x) lit += test::is_background(image.pixel(x, y)) ? 0 : 1;
  }
  EXPECT_LT(lit, 60);
}

// Transparent lines show those behind them, whatever their order in the list.
TEST(RenderImage, TransparentLinesMixFromFarToNear) {
  const Line red = test::polyline({{-0.5, -0.5, 0.0}, {0.5, -0.5, 0.0}});
  const Line blue = test::polyline({{0.0, 0.5, -0.5}, {0.0, 0.5, 0.5}});
  std::array<std::array<int, 4>, 2> middle{};
  for (std::size_t i = 0; i < 2; ++i) {
    SceneView view = test::front_view(i == 0 ? std::vector<Line>{red, blue} : std::vector<Line>{blue, red});
    view.style.color_by = ColorBy::kDirection;
    view.style.opacity = 0.5;
    middle[i] = test::at(render_image(view, test::kSize, test::kSize).image, 0.0, 0.0);
  }
  EXPECT_EQ(middle[0], middle[1]);
  EXPECT_GT(middle[0][0], 60);
  EXPECT_GT(middle[0][2], 40);
}

TEST(RenderImage, TwoPicturesOfOneViewAreTheSame) {
  const SceneView view = test::whirlwind(1.0);
  EXPECT_EQ(render_image(view, test::kSize, test::kSize).image.rgba,
            render_image(view, test::kSize, test::kSize, 2).image.rgba);
}

TEST(RenderImage, ScalingTheDataByAPowerOfTwoGivesTheSamePicture) {
  SceneView view = test::whirlwind(1.0), large = test::whirlwind(1.0, 60, std::ldexp(1.0, 60));
  view.show_color_bar = large.show_color_bar = false;  // its numbers do change
  EXPECT_EQ(render_image(view, test::kSize, test::kSize).image.rgba,
            render_image(large, test::kSize, test::kSize).image.rgba);
}

// Far from the origin the data's own doubles are coarser, and so the points move a little; units that are
// no power of two apart may choose another tolerance of at most a quarter of a pixel.
TEST(RenderImage, DataFarFromTheOriginAndAtTheExtremesDrawsTheSame) {
  SceneView view = test::whirlwind(1.0);
  view.show_color_bar = false;
  const Image expected = render_image(view, test::kSize, test::kSize).image;
  SceneView cases[] = {test::whirlwind(1.0, 60, 1.0, Vec3(1e8, -2e8, 3e8)), test::whirlwind(1.0, 60, 1e30),
                       test::whirlwind(1.0, 60, 1e-30)};
  for (SceneView& other : cases) {
    other.show_color_bar = false;
    EXPECT_LT(test::mean_difference(render_image(other, test::kSize, test::kSize).image, expected), 0.25);
  }
}

TEST(RenderImage, EmptyAndDegenerateScenesGiveAPicture) {
  SceneView empty;
  EXPECT_EQ(render_image(empty, 64, 48).image.rgba.size(), 4U * 64 * 48);
  SceneView point = test::front_view({test::polyline({{0.1, 0.1, 0.1}}), test::polyline({}),
                                      test::polyline({{NAN, 0, 0}, {0, NAN, 0}, {0, 0, HUGE_VAL}})});
  point.bounds = {Vec3(0.1), Vec3(0.1)};
  for (const ColorBy by : {ColorBy::kSpeed, ColorBy::kError, ColorBy::kTermination, ColorBy::kSeed}) {
    point.style.color_by = by;
    EXPECT_TRUE(test::is_background(render_image(point, 64, 48).image.pixel(32, 24)));
  }
}

// While a slow scene is turned: coarser lines, the same text at the same place.
TEST(SceneRenderer, CoarserResolutionGivesNearlyTheSamePicture) {
  const OffscreenContext context;
  SceneRenderer renderer;
  SceneView view = test::whirlwind(1.0);
  view.style.width = 8.0;
  renderer.draw(view, test::kSize, test::kSize);
  const Image fine = renderer.read();
  renderer.draw(view, test::kSize, test::kSize, 0.5);
  const Image coarse = renderer.read();
  EXPECT_EQ(coarse.width, test::kSize);
  EXPECT_GT(test::mean_difference(fine, coarse), 0.1);
  EXPECT_LT(test::mean_difference(fine, coarse), 8.0);
  renderer.draw(view, test::kSize, test::kSize);
  EXPECT_EQ(renderer.read().rgba, fine.rgba);
}

TEST(RenderImage, SizesThatCannotBeDrawnAreRefused) {
  try {
    (void)render_image(SceneView{}, 1'000'000, 10);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    EXPECT_NE(std::string(error.what()).find("1000000x10"), std::string::npos);
  }
}

TEST(RenderImage, TitleAxesAndColourBarLeaveTheirMarks) {
  SceneView view = test::whirlwind(1.0);
  view.lines = std::make_shared<const std::vector<Line>>(
      std::vector<Line>{test::polyline({{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}}, 1.0)});
  view.show_outline = view.show_axes = view.show_color_bar = false;
  const auto lit = [&](int x0, int x1, int y0, int y1) {
    const Image image = render_image(view, test::kSize, test::kSize).image;
    int count = 0;
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) count += test::is_background(image.pixel(x, y)) ? 0 : 1;
    }
    return count;
  };
  EXPECT_EQ(lit(0, test::kSize, 0, 40), 0);
  view.title = "whirlwind";
  EXPECT_GT(lit(0, test::kSize, 0, 40), 40);
  EXPECT_EQ(lit(0, 70, 130, test::kSize), 0);
  view.show_axes = true;
  EXPECT_GT(lit(0, 70, 130, test::kSize), 40);
  EXPECT_EQ(lit(150, test::kSize, 50, 150), 0);
  view.show_color_bar = true;
  EXPECT_GT(lit(150, test::kSize, 50, 150), 300);
}

// Without text: which font there is depends on the system.
SceneView plain_whirlwind() {
  SceneView view = test::whirlwind(4.0 / 3.0, 40);
  view.show_axes = view.show_color_bar = false;
  view.style.width = 8.0;
  return view;
}

TEST(Baseline, DarkPerspectiveBySpeed) { test::expect_baseline(plain_whirlwind(), "whirlwind_dark"); }

TEST(Baseline, LightOrthographicByError) {
  SceneView view = plain_whirlwind();
  view.background = Background::kLight;
  view.camera.projection = Projection::kOrthographic;
  view.style.color_by = ColorBy::kError;
  test::expect_baseline(view, "whirlwind_light");
}

TEST(Baseline, TransparentByTermination) {
  SceneView view = plain_whirlwind();
  view.style.opacity = 0.5;
  view.style.color_by = ColorBy::kTermination;
  test::expect_baseline(view, "whirlwind_transparent");
}

// Pictures with everything on them, for the eye (see cache_picture).
TEST(Look, AtWhatUsersSee) {
  if (std::getenv("PALPATE_PICTURES") == nullptr) GTEST_SKIP() << "PALPATE_PICTURES names no folder";
  constexpr int kWidth = 1280, kHeight = 800;
  SceneView view = test::whirlwind(1.6, 120);
  view.title = "whirlwind";
  view.subtitle = "120 lines";
  view.units = {"m", "s"};
  test::cache_picture(render_image(view, kWidth, kHeight).image, "dark");
  view.background = Background::kLight;
  test::cache_picture(render_image(view, kWidth, kHeight).image, "light");
  view.style.color_by = ColorBy::kError;
  test::cache_picture(render_image(view, kWidth, kHeight).image, "light_error");
  view.style.opacity = 0.4;
  view.style.color_by = ColorBy::kTermination;
  test::cache_picture(render_image(view, kWidth, kHeight).image, "light_transparent");
  view.background = Background::kDark;
  view.style = {};
  view.style.color_by = ColorBy::kTime;
  view.style.color_map = ColorMap::kDiverging;
  test::cache_picture(render_image(view, kWidth, kHeight).image, "diverging");
  view.style = {};
  view.style.color_by = ColorBy::kDirection;
  view.style.width = 8.0;
  test::cache_picture(render_image(view, 640, 400).image, "direction");

  view.style = {};
  view.probe = test::sample_probe(view);
  test::cache_picture(render_image(view, kWidth, kHeight).image, "probe_dark");
  view.background = Background::kLight;
  test::cache_picture(render_image(view, kWidth, kHeight).image, "probe_light");
  view.style.dimming = 0.35;
  view.camera.focal_point = view.probe->proxy;
  zoom(view.camera, 2.6);
  test::cache_picture(render_image(view, kWidth, kHeight).image, "probe_near");
}

// A solid with an enamel about it and a sharp transfer function, as a tooth has; an opaque line goes through
// it.
SceneView tooth_like(double samples) {
  const auto tooth = [](const Vec3& x) {
    const double r = glm::length(x * Vec3(1.0, 1.3, 0.8)) + 0.06 * std::sin(9.0 * x.x) * std::cos(7.0 * x.z);
    return r > 0.8 ? 0.0 : r > 0.6 ? 1.0 : r > 0.25 ? 0.6 : 0.2;
  };
  SceneView view = test::front_view({test::polyline({{-0.9, 0.0, 0.9}, {0.9, 0.1, -0.8}})});
  VolumeView volume = test::sampled_view(tooth, ScalarType::kUint8, 33);
  volume.transfer = ColorTransfer({{0.15 * 255, Vec3f(0.6F, 0.1F, 0.1F), 0.0},
                                   {0.25 * 255, Vec3f(0.8F, 0.3F, 0.2F), 0.08},
                                   {0.5 * 255, Vec3f(0.9F, 0.8F, 0.5F), 0.01},
                                   {0.9 * 255, Vec3f(1.0F, 1.0F, 0.9F), 0.3}});
  volume.shading = true;
  volume.samples_per_voxel = samples;
  view.volume = volume;
  return view;
}

// Against the error of all pixels, within four times the spread that as many of these, taken at random, have.
TEST(ImageErrorEstimate, AgreesWithTheErrorOfAllPixels) {
  constexpr int kWidth = 150, kHeight = 110;
  double before = 1.0;
  for (const double samples : {0.25, 4.0}) {
    SceneView view = tooth_like(samples);
    if (samples > 1.0) {  // a part of it enlarged
      view.volume->lenses = {{.shape = make_sphere(Vec3(0.2, 0.0, 0.1), 0.5)}};
      view.volume->lenses[0].magnification = 1.5;
    }
    SceneView best = view;
    best.volume = converged_view(*view.volume);
    const RenderedImage rendered = render_image(view, kWidth, kHeight, 0, 0.0, true);
    const Image converged = render_image(best, kWidth, kHeight).image;
    double sum = 0.0, squares = 0.0;
    int worst = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        double q = 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
          const int off = std::abs(rendered.image.pixel(x, y)[c] - converged.pixel(x, y)[c]);
          worst = std::max(worst, off);
          q += off * off / (3.0 * 255.0 * 255.0);
        }
        sum += q;
        squares += q * q;
      }
    }
    constexpr double kPixels = kWidth * kHeight;
    const double mean = sum / kPixels, deviation = std::sqrt(squares / kPixels - mean * mean);
    ASSERT_TRUE(rendered.error);
    const ImageError& error = *rendered.error;
    EXPECT_GT(error.pixels, 600U);
    EXPECT_LT(error.pixels, 0.2 * kPixels) << "that is not sparse";
    const double off = 4.0 * deviation / std::sqrt(static_cast<double>(error.pixels));
    EXPECT_NEAR(error.rms * error.rms, mean, off) << samples;
    EXPECT_NEAR(error.spread, off / 4.0 / (2.0 * std::sqrt(mean)), 0.5 * off / 4.0 / (2.0 * std::sqrt(mean)));
    EXPECT_LE(error.worst, worst / 255.0 + 1e-9);
    EXPECT_GT(error.worst, error.rms);
    EXPECT_LT(error.rms, before) << "more samples are no better";
    before = error.rms;
  }
  SceneView best = tooth_like(1.0);
  best.volume = converged_view(*best.volume);
  const RenderedImage exact = render_image(best, kWidth, kHeight, 0, 0.0, true);
  EXPECT_EQ(exact.error->rms, 0.0) << "converged";
}

// With fewer pixels outside lenses, and in all.
TEST(ImageErrorEstimate, TellsWhatFewerPixelsCost) {
  SceneView view = tooth_like(4.0);
  view.volume->lenses = {{.shape = make_sphere(Vec3(0.2, 0.0, 0.1), 0.3)}};
  const double whole = render_image(view, 96, 72, 0, 0.0, true).error->rms;
  view.volume->context.viewport = 0.4;
  EXPECT_GT(render_image(view, 96, 72, 0, 0.0, true).error->rms, 1.5 * whole);
  view.volume->shown = false;
  EXPECT_FALSE(render_image(view, 96, 72, 0, 0.0, true).error) << "there is no volume";
}

}  // namespace
}  // namespace palpate
