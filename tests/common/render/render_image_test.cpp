#include "common/render/render_image.h"

#include <cmath>
#include <filesystem>
#include <memory>

#include <gtest/gtest.h>
#include <stb_image.h>

#include "common/base/error.h"
#include "common/render/gl/context.h"
#include "common/render/scene_renderer.h"
#include "tests/common/render/sample_probe.h"
#include "tests/common/render/sample_scenes.h"

namespace palpate {
namespace {

constexpr int kSize = 200;

// An orthographic view along +y of the box [-1, 1]^3 without anything but lines: x to the right, z up.
// The view is 2.44 high (22 % of room at the sides), so a data unit is kSize / 2.44 pixels.
SceneView front_view(std::vector<Line> lines) {
  SceneView view;
  view.bounds = {Vec3(-1.0), Vec3(1.0)};
  view.lines = std::make_shared<const std::vector<Line>>(std::move(lines));
  view.camera = make_camera(view.bounds, {.azimuth = 0.0, .elevation = 0.0}, 1.0, Projection::kOrthographic);
  view.show_outline = view.show_axes = view.show_color_bar = false;
  view.style.width = 30.0;  // 6 pixels
  view.style.depth_cue = false;
  return view;
}

struct Pixel {
  int x, y;
};

Pixel where(double x, double z) {
  const double unit = kSize / 2.44;
  return {static_cast<int>(0.5 * kSize + unit * x), static_cast<int>(0.5 * kSize - unit * z)};
}

std::array<int, 4> at(const Image& image, double x, double z) {
  const Pixel p = where(x, z);
  return image.pixel(p.x, p.y);
}

bool is_background(const std::array<int, 4>& c) { return c[0] < 40 && c[1] < 40 && c[2] < 45; }

TEST(RenderImage, LinesLieWhereProjectionPutsThem) {
  SceneView view = front_view({test::polyline({{-0.8, 0.0, 0.5}, {0.8, 0.0, 0.5}}),
                               test::polyline({{-0.3, 0.0, -0.9}, {-0.3, 0.0, 0.1}})});
  view.style.color_by = ColorBy::kDirection;
  const Image image = render_image(view, kSize, kSize).image;
  ASSERT_EQ(image.rgba.size(), 4U * kSize * kSize);
  for (const double x : {-0.75, 0.0, 0.75}) {
    const auto along_x = at(image, x, 0.5);
    EXPECT_GT(along_x[0], 120) << x;
    EXPECT_GT(along_x[0], along_x[1] + 60) << x;
    EXPECT_GT(along_x[0], along_x[2] + 60) << x;
    EXPECT_TRUE(is_background(at(image, x, 0.62))) << x;
    EXPECT_TRUE(is_background(at(image, x, 0.38))) << x;
  }
  const auto along_z = at(image, -0.3, -0.5);
  EXPECT_GT(along_z[2], along_z[0] + 60);
  EXPECT_TRUE(is_background(at(image, 0.9, 0.5)));
  EXPECT_TRUE(is_background(at(image, -0.3, 0.3)));
}

TEST(RenderImage, WidthIsInThousandthsOfTheHeight) {
  SceneView view = front_view({test::polyline({{-0.8, 0.0, 0.0}, {0.8, 0.0, 0.0}})});
  view.style.halo = false;
  view.style.color_by = ColorBy::kUniform;
  view.style.width = 50.0;  // 10 pixels
  const Image image = render_image(view, kSize, kSize).image;
  int lit = 0;
  for (int y = 0; y < kSize; ++y) lit += is_background(image.pixel(kSize / 2, y)) ? 0 : 1;
  EXPECT_GE(lit, 9);
  EXPECT_LE(lit, 11);
}

TEST(RenderImage, NearerLineHidesTheFartherOne) {
  // Looking along +y: smaller y is nearer. The far line comes last in the list.
  SceneView view = front_view({test::polyline({{-0.5, -0.5, 0.0}, {0.5, -0.5, 0.0}}),
                               test::polyline({{0.0, 0.5, -0.5}, {0.0, 0.5, 0.5}})});
  view.style.color_by = ColorBy::kDirection;
  for (const Projection projection : {Projection::kOrthographic, Projection::kPerspective}) {
    view.camera.projection = projection;
    const Image image = render_image(view, kSize, kSize).image;
    const auto middle = at(image, 0.0, 0.0);
    EXPECT_GT(middle[0], middle[2] + 60);
  }
}

TEST(RenderImage, HaloCutsTheLineBehind) {
  SceneView view = front_view({test::polyline({{-0.5, -0.5, 0.0}, {0.5, -0.5, 0.0}}),
                               test::polyline({{0.0, 0.5, -0.5}, {0.0, 0.5, 0.5}})});
  view.style.color_by = ColorBy::kDirection;
  // Just outside the edge of the near line (3 pixels from its middle), upon the far one.
  const double beside = 4.0 * 2.44 / kSize;
  EXPECT_TRUE(is_background(at(render_image(view, kSize, kSize).image, 0.0, beside)));
  view.style.halo = false;
  EXPECT_FALSE(is_background(at(render_image(view, kSize, kSize).image, 0.0, beside)));
}

TEST(RenderImage, ColoursFollowTheMap) {
  Line line;
  for (int i = 0; i <= 10; ++i) line.points.push_back({{-0.9 + 0.18 * i, 0.0, 0.0}, 0.0, 0.0, 3.0 + i, 1.0});
  SceneView view = front_view({line});
  view.style.range = ValueRange{3.0, 13.0};
  view.style.width = 60.0;
  const Image image = render_image(view, kSize, kSize).image;
  // Light changes brightness, not hue: compare hue angles in CIELAB.
  for (const double t : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    const auto pixel = at(image, -0.9 + 1.8 * t, 0.0);
    const Vec3 found = lab_from_srgb(Vec3(pixel[0], pixel[1], pixel[2]) / 255.0);
    const Vec3 expected = lab_from_srgb(Vec3(map_color(ColorMap::kSequential, t)));
    const double turned =
        std::remainder(std::atan2(found.z, found.y) - std::atan2(expected.z, expected.y), 6.283185307);
    EXPECT_LT(std::abs(turned), 0.25) << t;
  }
}

TEST(RenderImage, ValuesThatAreNotNumbersAreGrey) {
  SceneView view = front_view({test::polyline({{-0.8, 0.0, 0.0}, {0.8, 0.0, 0.0}}, std::nan(""))});
  const Image image = render_image(view, kSize, kSize).image;
  const auto c = at(image, 0.0, 0.0);
  EXPECT_FALSE(is_background(c));
  EXPECT_NEAR(c[0], c[1], 6);
  EXPECT_NEAR(c[1], c[2], 6);
}

TEST(RenderImage, LineTowardTheEyeIsADot) {
  SceneView view = front_view({test::polyline({{0.2, -0.9, 0.3}, {0.2, 0.9, 0.3}})});
  view.style.color_by = ColorBy::kUniform;
  const Image image = render_image(view, kSize, kSize).image;
  int lit = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) lit += is_background(image.pixel(x, y)) ? 0 : 1;
  }
  EXPECT_LT(lit, 60);
}

// Transparent lines show those behind them, whatever their order in the list.
TEST(RenderImage, TransparentLinesMixFromFarToNear) {
  const Line red = test::polyline({{-0.5, -0.5, 0.0}, {0.5, -0.5, 0.0}});
  const Line blue = test::polyline({{0.0, 0.5, -0.5}, {0.0, 0.5, 0.5}});
  std::array<std::array<int, 4>, 2> middle{};
  for (std::size_t i = 0; i < 2; ++i) {
    SceneView view = front_view(i == 0 ? std::vector<Line>{red, blue} : std::vector<Line>{blue, red});
    view.style.color_by = ColorBy::kDirection;
    view.style.opacity = 0.5;
    middle[i] = at(render_image(view, kSize, kSize).image, 0.0, 0.0);
  }
  EXPECT_EQ(middle[0], middle[1]);
  EXPECT_GT(middle[0][0], 60);
  EXPECT_GT(middle[0][2], 40);
}

TEST(RenderImage, TwoPicturesOfOneViewAreTheSame) {
  const SceneView view = test::whirlwind(1.0);
  EXPECT_EQ(render_image(view, kSize, kSize).image.rgba, render_image(view, kSize, kSize, 2).image.rgba);
}

TEST(RenderImage, ScalingTheDataByAPowerOfTwoGivesTheSamePicture) {
  SceneView view = test::whirlwind(1.0), large = test::whirlwind(1.0, 60, std::ldexp(1.0, 60));
  view.show_color_bar = large.show_color_bar = false;  // its numbers do change
  EXPECT_EQ(render_image(view, kSize, kSize).image.rgba, render_image(large, kSize, kSize).image.rgba);
}

double mean_difference(const Image& a, const Image& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) sum += std::abs(a.rgba[i] - b.rgba[i]);
  return sum / static_cast<double>(a.rgba.size());
}

// Far from the origin the data's own doubles are coarser, and so the points move a little; units that are
// no power of two apart may choose another tolerance of at most a quarter of a pixel.
TEST(RenderImage, DataFarFromTheOriginAndAtTheExtremesDrawsTheSame) {
  SceneView view = test::whirlwind(1.0);
  view.show_color_bar = false;
  const Image expected = render_image(view, kSize, kSize).image;
  SceneView cases[] = {test::whirlwind(1.0, 60, 1.0, Vec3(1e8, -2e8, 3e8)), test::whirlwind(1.0, 60, 1e30),
                       test::whirlwind(1.0, 60, 1e-30)};
  for (SceneView& other : cases) {
    other.show_color_bar = false;
    EXPECT_LT(mean_difference(render_image(other, kSize, kSize).image, expected), 0.25);
  }
}

TEST(RenderImage, EmptyAndDegenerateScenesGiveAPicture) {
  SceneView empty;
  EXPECT_EQ(render_image(empty, 64, 48).image.rgba.size(), 4U * 64 * 48);
  SceneView point = front_view({test::polyline({{0.1, 0.1, 0.1}}), test::polyline({}),
                                test::polyline({{NAN, 0, 0}, {0, NAN, 0}, {0, 0, HUGE_VAL}})});
  point.bounds = {Vec3(0.1), Vec3(0.1)};
  for (const ColorBy by : {ColorBy::kSpeed, ColorBy::kError, ColorBy::kTermination, ColorBy::kSeed}) {
    point.style.color_by = by;
    EXPECT_TRUE(is_background(render_image(point, 64, 48).image.pixel(32, 24)));
  }
}

// While a slow scene is turned: coarser lines, the same text at the same place.
TEST(SceneRenderer, CoarserResolutionGivesNearlyTheSamePicture) {
  const OffscreenContext context;
  SceneRenderer renderer;
  SceneView view = test::whirlwind(1.0);
  view.style.width = 8.0;
  renderer.draw(view, kSize, kSize);
  const Image fine = renderer.read();
  renderer.draw(view, kSize, kSize, 0.5);
  const Image coarse = renderer.read();
  EXPECT_EQ(coarse.width, kSize);
  EXPECT_GT(mean_difference(fine, coarse), 0.1);
  EXPECT_LT(mean_difference(fine, coarse), 8.0);
  renderer.draw(view, kSize, kSize);
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
    const Image image = render_image(view, kSize, kSize).image;
    int count = 0;
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) count += is_background(image.pixel(x, y)) ? 0 : 1;
    }
    return count;
  };
  EXPECT_EQ(lit(0, kSize, 0, 40), 0);
  view.title = "whirlwind";
  EXPECT_GT(lit(0, kSize, 0, 40), 40);
  EXPECT_EQ(lit(0, 70, 130, kSize), 0);
  view.show_axes = true;
  EXPECT_GT(lit(0, 70, 130, kSize), 40);
  EXPECT_EQ(lit(150, kSize, 50, 150), 0);
  view.show_color_bar = true;
  EXPECT_GT(lit(150, kSize, 50, 150), 300);
}

// Pictures kept beside the tests, looked at by people. Rasterisers of other makes and versions place
// some samples differently: the mean over all bytes and the share of clearly different pixels may reach
// these bounds. PALPATE_UPDATE_BASELINES writes the pictures anew.
void expect_baseline(const SceneView& view, const std::string& name) {
  constexpr double kMeanBound = 0.5, kShareBound = 0.005;
  constexpr int kClearlyDifferent = 24;
  constexpr int kWidth = 240, kHeight = 180;
  const Image image = render_image(view, kWidth, kHeight).image;
  const auto path = std::filesystem::path(PALPATE_SOURCE_DIR) / "tests/baselines" / (name + ".png");
  if (std::getenv("PALPATE_UPDATE_BASELINES") != nullptr) {
    std::filesystem::create_directories(path.parent_path());
    write_png(path, image, {});
  }
  Image baseline;
  int channels = 0;
  stbi_uc* pixels = stbi_load(path.c_str(), &baseline.width, &baseline.height, &channels, 4);
  ASSERT_NE(pixels, nullptr) << path;
  ASSERT_EQ(baseline.width, kWidth);
  ASSERT_EQ(baseline.height, kHeight);
  baseline.rgba.assign(pixels, pixels + 4 * kWidth * kHeight);
  std::free(pixels);
  EXPECT_LT(mean_difference(image, baseline), kMeanBound) << name;
  int different = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto a = image.pixel(x, y), b = baseline.pixel(x, y);
      int worst = 0;
      for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(a[c] - b[c]));
      different += worst > kClearlyDifferent ? 1 : 0;
    }
  }
  EXPECT_LT(different, kShareBound * kWidth * kHeight) << name;
}

// Without text: which font there is depends on the system.
SceneView plain_whirlwind() {
  SceneView view = test::whirlwind(4.0 / 3.0, 40);
  view.show_axes = view.show_color_bar = false;
  view.style.width = 8.0;
  return view;
}

TEST(Baseline, DarkPerspectiveBySpeed) { expect_baseline(plain_whirlwind(), "whirlwind_dark"); }

TEST(Baseline, LightOrthographicByError) {
  SceneView view = plain_whirlwind();
  view.background = Background::kLight;
  view.camera.projection = Projection::kOrthographic;
  view.style.color_by = ColorBy::kError;
  expect_baseline(view, "whirlwind_light");
}

TEST(Baseline, TransparentByTermination) {
  SceneView view = plain_whirlwind();
  view.style.opacity = 0.5;
  view.style.color_by = ColorBy::kTermination;
  expect_baseline(view, "whirlwind_transparent");
}

// Pictures with everything on them, for the eye (see keep_picture).
TEST(Look, AtWhatUsersSee) {
  if (std::getenv("PALPATE_PICTURES") == nullptr) GTEST_SKIP() << "PALPATE_PICTURES names no folder";
  constexpr int kWidth = 1280, kHeight = 800;
  SceneView view = test::whirlwind(1.6, 120);
  view.title = "whirlwind";
  view.subtitle = "120 lines";
  view.units = {"m", "s"};
  test::keep_picture(render_image(view, kWidth, kHeight).image, "dark");
  view.background = Background::kLight;
  test::keep_picture(render_image(view, kWidth, kHeight).image, "light");
  view.style.color_by = ColorBy::kError;
  test::keep_picture(render_image(view, kWidth, kHeight).image, "light_error");
  view.style.opacity = 0.4;
  view.style.color_by = ColorBy::kTermination;
  test::keep_picture(render_image(view, kWidth, kHeight).image, "light_transparent");
  view.background = Background::kDark;
  view.style = {};
  view.style.color_by = ColorBy::kTime;
  view.style.color_map = ColorMap::kDiverging;
  test::keep_picture(render_image(view, kWidth, kHeight).image, "diverging");
  view.style = {};
  view.style.color_by = ColorBy::kDirection;
  view.style.width = 8.0;
  test::keep_picture(render_image(view, 640, 400).image, "direction");

  view.style = {};
  view.probe = test::sample_probe(view);
  test::keep_picture(render_image(view, kWidth, kHeight).image, "probe_dark");
  view.background = Background::kLight;
  test::keep_picture(render_image(view, kWidth, kHeight).image, "probe_light");
}

}  // namespace
}  // namespace palpate
