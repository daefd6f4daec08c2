// Lines with less detail, in part outside the picture, and left while they are drawn.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/render/gl/context.h"
#include "common/render/scene_renderer.h"
#include "tests/common/render/sample_scenes.h"

namespace palpate {
namespace {

constexpr int kWidth = 300, kHeight = 200;

Image picture_of(SceneRenderer& renderer, const SceneView& view, double detail = 1.0) {
  renderer.set_line_detail(detail);
  renderer.draw(view, kWidth, kHeight);
  renderer.finish();
  return renderer.read();
}

double difference(const Image& a, const Image& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    const double d = (a.rgba[i] - b.rgba[i]) / 255.0;
    sum += d * d;
  }
  return std::sqrt(sum / (0.75 * static_cast<double>(a.rgba.size())));
}

SceneView plain_whirlwind(int lines) {
  SceneView view = test::whirlwind(static_cast<double>(kWidth) / kHeight, lines);
  view.show_axes = view.show_color_bar = false;
  return view;
}

TEST(LineDetail, ChangesThePictureLittleFirstAndNotForGood) {
  const OffscreenContext context;
  SceneRenderer renderer;
  const SceneView view = plain_whirlwind(200);
  SceneView empty = view;
  empty.lines = nullptr;
  const Image nothing = picture_of(renderer, empty), full = picture_of(renderer, view);
  const double all = difference(full, nothing);
  const double half = difference(full, picture_of(renderer, view, 0.5));
  const double least = difference(full, picture_of(renderer, view, 0.03));
  EXPECT_GT(half, 0.0) << "fewer segments";
  EXPECT_LT(half, 0.5 * all);
  EXPECT_GT(least, half);
  EXPECT_LT(least, all) << "some lines are there";
  EXPECT_EQ(picture_of(renderer, view).rgba, full.rgba);
}

// Runs of segments that lie outside the picture are not drawn. In another order the lines make other runs.
TEST(LineDetail, WhatIsOutsideThePictureIsLeftOutAlone) {
  const OffscreenContext context;
  SceneRenderer renderer;
  SceneView view = plain_whirlwind(200);
  auto reversed = std::make_shared<std::vector<Line>>(*view.lines);
  std::reverse(reversed->begin(), reversed->end());
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    view.camera.projection = projection;
    zoom(view.camera, 1.7, 0.2, 0.3);
    SceneView other = view;
    other.lines = reversed;
    EXPECT_LT(difference(picture_of(renderer, view), picture_of(renderer, other)), 0.003);
  }
}

TEST(LineDetail, APictureOfLinesCanBeLeft) {
  const OffscreenContext context;
  SceneRenderer renderer;
  const SceneView view = plain_whirlwind(100);
  const Image whole = picture_of(renderer, view);
  SceneView turned = view;
  turn(turned.camera, 0.4, 0.1);
  int asked = 0;
  EXPECT_FALSE(renderer.draw(turned, kWidth, kHeight, 1.0, HUGE_VAL, {}, [&] { return ++asked > 0; }));
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(renderer.read().rgba, whole.rgba) << "the last one stays";
  EXPECT_TRUE(renderer.draw(turned, kWidth, kHeight, 1.0, HUGE_VAL, {}, [] { return false; }));
  const Image asking = renderer.read();
  EXPECT_EQ(picture_of(renderer, turned).rgba, asking.rgba);
}

}  // namespace
}  // namespace palpate
