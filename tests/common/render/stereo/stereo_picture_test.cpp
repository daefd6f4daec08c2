// Pictures of two eyes: each mode holds the pictures of both, and points lie apart as the formula says.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "common/render/gl/context.h"
#include "common/render/gl/object.h"
#include "common/render/render_image.h"
#include "common/render/stereo/stereo_pass.h"
#include "tests/common/render/sample_scenes.h"

namespace palpate {
namespace {

constexpr int kWidth = 400, kHeight = 300;

SceneView quiet(SceneView view) {
  view.show_axes = view.show_color_bar = view.show_outline = false;
  return view;
}

Image drawn(const SceneView& view, int width, int height) { return render_image(view, width, height).image; }

// One eye's picture by itself, from its camera.
Image eye_alone(SceneView view, std::size_t eye, int width, int height) {
  view.camera = stereo_eyes(view.camera, view.stereo, view.bounds).cameras[eye];
  view.stereo.mode = StereoMode::kNone;
  return drawn(view, width, height);
}

// Pixels of `image` that differ from eye `eye`'s picture where `shows` says that it is shown.
template <class Shows>
int strange_pixels(const Image& image, const Image& eye, int left, int top, const Shows& shows) {
  int count = 0;
  for (int y = 0; y < eye.height; ++y) {
    for (int x = 0; x < eye.width; ++x) {
      if (shows(x, y) && image.pixel(left + x, top + y) != eye.pixel(x, y)) ++count;
    }
  }
  return count;
}

TEST(StereoPicture, HoldsThePicturesOfBothEyesWhereTheModeSays) {
  SceneView view = test::whirlwind(4.0 / 3.0, 12);
  const auto all = [](int, int) { return true; };

  view.stereo.mode = StereoMode::kSideBySide;
  const Image beside = drawn(view, kWidth, kHeight);
  const int half = kWidth / 2;
  EXPECT_EQ(strange_pixels(beside, eye_alone(view, 0, half, kHeight), 0, 0, all), 0);
  EXPECT_EQ(strange_pixels(beside, eye_alone(view, 1, half, kHeight), half, 0, all), 0);
  EXPECT_GT(strange_pixels(beside, eye_alone(view, 0, half, kHeight), half, 0, all), 100);

  view.stereo.mode = StereoMode::kTopBottom;
  const Image above = drawn(view, kWidth, kHeight);
  EXPECT_EQ(strange_pixels(above, eye_alone(view, 0, kWidth, kHeight / 2), 0, 0, all), 0);
  EXPECT_EQ(strange_pixels(above, eye_alone(view, 1, kWidth, kHeight / 2), 0, kHeight / 2, all), 0);

  const Image left = eye_alone(view, 0, kWidth, kHeight), right = eye_alone(view, 1, kWidth, kHeight);
  view.stereo.mode = StereoMode::kRows;
  const Image rows = drawn(view, kWidth, kHeight);
  EXPECT_EQ(strange_pixels(rows, left, 0, 0, [](int, int y) { return y % 2 == 0; }), 0);
  EXPECT_EQ(strange_pixels(rows, right, 0, 0, [](int, int y) { return y % 2 == 1; }), 0);

  view.stereo.mode = StereoMode::kColumns;
  view.stereo.swapped = true;
  const Image columns = drawn(view, kWidth, kHeight);
  EXPECT_EQ(strange_pixels(columns, right, 0, 0, [](int x, int) { return x % 2 == 0; }), 0);
  EXPECT_EQ(strange_pixels(columns, left, 0, 0, [](int x, int) { return x % 2 == 1; }), 0);

  // A buffer for each eye: in one picture both in full, the left one on top.
  view.stereo.mode = StereoMode::kQuadBuffer;
  view.stereo.swapped = false;
  const Image both = drawn(view, kWidth, kHeight);
  ASSERT_EQ(both.height, 2 * kHeight);
  EXPECT_EQ(strange_pixels(both, left, 0, 0, all), 0);
  EXPECT_EQ(strange_pixels(both, right, 0, kHeight, all), 0);
}

// A window that lies a row further down, or a column to the right, begins at a row of the display that
// belongs to the other eye: each row of the display shows the eye that it showed before.
TEST(StereoPicture, RowsAndColumnsAreThoseOfTheDisplayWhereverTheWindowLies) {
  SceneView view = test::whirlwind(4.0 / 3.0, 12);
  view.stereo.mode = StereoMode::kRows;
  const Image left = eye_alone(view, 0, kWidth, kHeight), right = eye_alone(view, 1, kWidth, kHeight);
  for (const auto mode : {StereoMode::kRows, StereoMode::kColumns}) {
    view.stereo.mode = mode;
    for (const std::array<int, 2> first : {std::array{17, 40}, {0, 1}, {-1, -1}}) {
      view.stereo.first = first;
      const Image picture = drawn(view, kWidth, kHeight);
      const auto odd_on_display = [&](int x, int y) {
        return ((mode == StereoMode::kRows ? first[1] + y : first[0] + x) & 1) != 0;
      };
      EXPECT_EQ(strange_pixels(picture, left, 0, 0, [&](int x, int y) { return !odd_on_display(x, y); }), 0);
      EXPECT_EQ(strange_pixels(picture, right, 0, 0, odd_on_display), 0);
    }
  }
}

// The same copies that fill the two buffers of a window, into two buffers that can be read here: the left
// eye's picture goes into the first one, each whole and in its place; with one buffer there is the left eye.
TEST(StereoPicture, EachEyeIsCopiedIntoItsOwnBuffer) {
  const OffscreenContext context;
  constexpr int kEdge = 8, kAround = 12, kLeft = 3, kBottom = 2;
  const auto filled = [](int width, int height, std::size_t count,
                         const std::array<std::array<float, 4>, 2>& colors, std::vector<GlTexture>& kept) {
    GLuint framebuffer = 0;
    glCreateFramebuffers(1, &framebuffer);
    for (std::size_t i = 0; i < count; ++i) {
      GLuint name = 0;
      glCreateTextures(GL_TEXTURE_2D, 1, &name);
      kept.emplace_back(name);
      glTextureStorage2D(name, 1, GL_RGBA8, width, height);
      glClearTexImage(name, 0, GL_RGBA, GL_FLOAT, colors[i].data());
      glNamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i), name, 0);
    }
    return GlFramebuffer(framebuffer);
  };
  const std::array<float, 4> red{1.0F, 0.0F, 0.0F, 1.0F}, blue{0.0F, 0.0F, 1.0F, 1.0F},
      black{0.0F, 0.0F, 0.0F, 1.0F};
  std::vector<GlTexture> kept;
  const GlFramebuffer left = filled(kEdge, kEdge, 1, {red, red}, kept);
  const GlFramebuffer right = filled(kEdge, kEdge, 1, {blue, blue}, kept);
  const std::array<EyeSource, 2> eyes{EyeSource{left.name()}, EyeSource{right.name()}};
  for (const std::size_t count : {2U, 1U}) {
    std::vector<GlTexture> shown;
    const GlFramebuffer window = filled(kAround, kAround, 2, {black, black}, shown);
    const std::array<std::uint32_t, 2> buffers{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    show_eyes(eyes, kEdge, kEdge, window.name(), std::span(buffers).first(count), kLeft, kBottom);
    for (std::size_t i = 0; i < 2; ++i) {
      std::vector<std::uint8_t> rgba(4 * kAround * kAround);
      glGetTextureImage(shown[i].name(), 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(rgba.size()),
                        rgba.data());
      for (int y = 0; y < kAround; ++y) {
        for (int x = 0; x < kAround; ++x) {
          const bool inside = x >= kLeft && x < kLeft + kEdge && y >= kBottom && y < kBottom + kEdge;
          const bool there = inside && i < count;
          const std::size_t at = 4 * static_cast<std::size_t>(y * kAround + x);
          ASSERT_EQ(rgba[at], there && i == 0 ? 255 : 0) << count << " " << i << " " << x << " " << y;
          ASSERT_EQ(rgba[at + 2], there && i == 1 ? 255 : 0) << count << " " << i << " " << x << " " << y;
        }
      }
    }
  }
}

double linear(int byte) {
  const double c = byte / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}
int encoded(double c) {
  c = std::clamp(c, 0.0, 1.0);
  return static_cast<int>(
      std::lround(255.0 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055)));
}

TEST(StereoPicture, AnaglyphsMixColoursAsTheirMatricesSay) {
  using Rows = std::array<std::array<double, 6>, 3>;  // of the left eye's colours, then the right one's
  const Rows dubois{{{0.437, 0.449, 0.164, -0.011, -0.032, -0.007},
                     {-0.062, -0.062, -0.024, 0.377, 0.761, 0.009},
                     {-0.048, -0.050, -0.017, -0.026, -0.093, 1.234}}};
  const Rows grey{{{0.2126, 0.7152, 0.0722, 0, 0, 0},
                   {0, 0, 0, 0.2126, 0.7152, 0.0722},
                   {0, 0, 0, 0.2126, 0.7152, 0.0722}}};
  SceneView view = test::whirlwind(4.0 / 3.0, 12);
  view.stereo.mode = StereoMode::kAnaglyph;
  const Image left = eye_alone(view, 0, kWidth, kHeight), right = eye_alone(view, 1, kWidth, kHeight);
  for (const auto& [mode, matrix] :
       {std::pair(StereoMode::kAnaglyph, dubois), std::pair(StereoMode::kAnaglyphGrey, grey)}) {
    view.stereo.mode = mode;
    const Image picture = drawn(view, kWidth, kHeight);
    int worst = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const auto l = left.pixel(x, y), r = right.pixel(x, y), p = picture.pixel(x, y);
        for (std::size_t row = 0; row < 3; ++row) {
          double sum = 0.0;
          for (std::size_t c = 0; c < 3; ++c)
            sum += matrix[row][c] * linear(l[c]) + matrix[row][c + 3] * linear(r[c]);
          worst = std::max(worst, std::abs(encoded(sum) - p[row]));
        }
      }
    }
    EXPECT_LE(worst, 1);
  }
}

// The middle of what is drawn: of a short upright line, its x in pixels.
double middle_of(const Image& image, int left, int width) {
  const auto nothing = image.pixel(left, 0);
  double sum = 0.0, weight = 0.0;
  for (int y = image.height / 4; y < 3 * image.height / 4; ++y) {
    for (int x = left; x < left + width; ++x) {
      const auto p = image.pixel(x, y);
      // Backgrounds are a gradient: lines are far brighter.
      const double bright = std::max(0, p[0] + p[1] + p[2] - nothing[0] - nothing[1] - nothing[2] - 90);
      sum += bright * (x - left + 0.5);
      weight += bright;
    }
  }
  return weight > 0.0 ? sum / weight : std::numeric_limits<double>::quiet_NaN();
}

// A point at depth z is drawn e (z - d) / z further right for the right eye than for the left one, on a
// screen at d.
TEST(StereoPicture, APointLiesApartAsItsDepthSays) {
  for (const double depth : {-0.9, -0.4, 0.0, 0.5, 0.9}) {
    SceneView view;
    view.bounds = {Vec3(-1.0), Vec3(1.0)};
    auto lines = std::make_shared<std::vector<Line>>();
    lines->push_back(test::polyline({{0.1, depth, -0.3}, {0.1, depth, 0.3}}));
    view.lines = lines;
    view.style.color_by = ColorBy::kUniform;
    view.style.halo = false;
    view.style.depth_cue = false;
    view.camera = make_camera(view.bounds, {.azimuth = 0, .elevation = 0}, 1.0);
    view = quiet(view);
    view.stereo = {.mode = StereoMode::kSideBySide, .separation = 0.1, .most_disparity = 1.0};
    constexpr int kEdge = 500;
    const Image image = drawn(view, 2 * kEdge, kEdge);
    const double apart = middle_of(image, kEdge, kEdge) - middle_of(image, 0, kEdge);
    const double d = distance(view.camera), z = d + depth, e = 0.1 * d;
    EXPECT_NEAR(apart, e * (z - d) / z * kEdge / view.camera.view_height, 0.5) << depth;
  }
}

}  // namespace
}  // namespace palpate
