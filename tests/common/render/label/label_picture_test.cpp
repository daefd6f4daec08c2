// Signs in space: they are drawn where they are, for each eye, with words that can be seen, and what is
// nearer hides them.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/render/render_image.h"
#include "tests/common/render/sample_scenes.h"

namespace palpate::test {
namespace {

constexpr int kEdge = 200;

SceneView empty_scene() {
  SceneView view;
  view.bounds = {Vec3(-1.0), Vec3(1.0)};
  view.camera = make_camera(view.bounds, {.azimuth = 0.0, .elevation = 0.0}, 1.0);
  view.show_axes = view.show_color_bar = view.show_outline = false;
  return view;
}

/// A red rectangle upright on the direction of view, to the right of the origin: one unit across, two high.
LabelView rectangle(const SceneView& view, const Vec3& middle) {
  LabelView label{.origin = middle, .axes = view.camera.axes, .unit = 0.2};
  label.shapes.push_back({{{0.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {0.0, 1.0}}, {1.0F, 0.0F, 0.0F}, 1.0F});
  return label;
}

bool red(const Image& image, int x, int y) {
  const auto p = image.pixel(x, y);
  return p[0] > 200 && p[1] < 60 && p[2] < 60;
}

TEST(LabelPicture, CoversWhatItsCornersSay) {
  for (const Vec3& middle :
       {Vec3(0.0), Vec3(0.4, -0.8, 0.3), Vec3(-0.3, 3.0, -0.2)}) {  // outside the box, too
    SceneView view = empty_scene();
    view.labels = {rectangle(view, middle)};
    const Image image = render_image(view, kEdge, kEdge).image;
    const Vec3 shown = project(view.camera, middle, kEdge, kEdge);
    const double half = 0.2 * kEdge / view.camera.view_height * distance(view.camera) / shown.z;
    int wrong = 0;
    for (int y = 0; y < kEdge; ++y) {
      for (int x = 0; x < kEdge; ++x) {
        const double right = x + 0.5 - shown.x;
        const double off =
            std::max({-right, right - half, std::abs(y + 0.5 - shown.y) - half});  // below 0: on it
        if (std::abs(off) > 1.0 && red(image, x, y) != (off < 0.0)) ++wrong;
      }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(half, 5.0);
  }
}

// One with words turns to the viewer wherever that is.
TEST(LabelPicture, ShowsWordsThatFaceTheViewer) {
  SceneView view = empty_scene();
  LabelView label{.origin = Vec3(-0.6, 0.0, 0.0), .axes = Mat3(1.0), .unit = 0.3, .faces_viewer = true};
  label.texts.push_back(
      {.place = {0.0, 0.0}, .height = 1.0, .words = "Mitte äΩ", .color = {1.0F, 1.0F, 1.0F}});
  view.labels = {label};
  for (const double azimuth : {0.0, 70.0, 200.0}) {
    view.camera = make_camera(view.bounds, {.azimuth = azimuth, .elevation = 20.0}, 1.0);
    view.camera.focal_point = label.origin + 0.6 * view.camera.axes[0];
    const Image image = render_image(view, kEdge, kEdge).image;
    cache_picture(image, "sign_words_" + std::to_string(static_cast<int>(azimuth)));
    int bright = 0, outside = 0;
    const double line = 0.3 * kEdge / view.camera.view_height;
    for (int y = 0; y < kEdge; ++y) {
      for (int x = 0; x < kEdge; ++x) {
        const auto p = image.pixel(x, y);
        if (p[0] < 180) continue;
        ++(std::abs(y + 0.5 - 0.5 * kEdge) < 0.6 * line ? bright : outside);
      }
    }
    EXPECT_GT(bright, 60) << azimuth;  // some 80, as drivers filter letters
    EXPECT_EQ(outside, 0) << azimuth;
  }
}

TEST(LabelPicture, IsHiddenByWhatIsNearerAndHidesNothingThatIs) {
  SceneView view = empty_scene();
  auto lines = std::make_shared<std::vector<Line>>();
  lines->push_back(polyline({{0.0, -0.5, -0.8}, {0.0, -0.5, 0.8}}));  // the viewer is at negative y
  lines->push_back(polyline({{0.1, 0.5, -0.8}, {0.1, 0.5, 0.8}}));
  view.lines = lines;
  view.style.color_by = ColorBy::kUniform;
  view.style.halo = false;
  view.style.width = 30.0;
  view.labels = {rectangle(view, Vec3(0.0))};
  const Image image = render_image(view, kEdge, kEdge).image;
  const auto at = [&](const Vec3& x) {
    const Vec3 shown = project(view.camera, x, kEdge, kEdge);
    return red(image, static_cast<int>(shown.x), static_cast<int>(shown.y));
  };
  EXPECT_FALSE(at({0.0, -0.5, 0.05}));
  EXPECT_TRUE(at({0.1, 0.5, 0.05}));
}

// Its disparity is that of its depth, to half a pixel.
TEST(LabelPicture, LiesApartForTwoEyesAsItsDepthSays) {
  SceneView view = empty_scene();
  view.stereo = {.mode = StereoMode::kSideBySide, .separation = 0.1, .most_disparity = 1.0};
  const Vec3 middle = view.camera.focal_point + 0.7 * view.camera.axes[2];
  view.labels = {rectangle(view, middle)};
  const Image image = render_image(view, 2 * kEdge, kEdge).image;
  const auto middle_of = [&](int left) {
    // Pixels at its edges are partly red.
    const int behind = image.pixel(left, kEdge / 2)[0];
    double sum = 0.0, weight = 0.0;
    for (int x = left; x < left + kEdge; ++x) {
      const double share = std::max(0, image.pixel(x, kEdge / 2)[0] - behind);
      sum += share * (x - left + 0.5);
      weight += share;
    }
    return sum / weight;
  };
  const double d = distance(view.camera), z = d - 0.7;
  const double apart = 0.1 * d * (z - d) / z * kEdge / view.camera.view_height;
  EXPECT_NEAR(middle_of(kEdge) - middle_of(0), apart, 0.5);
}

}  // namespace
}  // namespace palpate::test
