// Where the probe appears when it is grabbed.
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "common/render/camera.h"
#include "common/window/controls/touch_control.h"

namespace palpate {
namespace {

constexpr PictureSize kSize{800, 600};

Line segment(const Vec3& a, const Vec3& b) {
  Line line;
  for (const Vec3& x : {a, b}) {
    line.points.emplace_back();
    line.points.back().position = x;
  }
  return line;
}

SceneView view_of(std::vector<Line> lines) {
  SceneView view;
  view.bounds = {Vec3{-1.0}, Vec3{1.0}};
  view.camera =
      make_camera(view.bounds, {.azimuth = 20.0, .elevation = 30.0}, 800.0 / 600.0, Projection::kPerspective);
  view.lines = std::make_shared<const std::vector<Line>>(std::move(lines));
  return view;
}

Vec3 shown(const SceneView& view, const Vec3& x) {
  return project(view.camera, x, kSize.width, kSize.height);
}

Vec3 start_at(const SceneView& view, double x, double y) { return start_of_probe(view, kSize, {x, y}); }

TEST(StartOfProbe, FarFromEveryLineItIsUnderTheMouseAtTheDepthOfTheFocalPoint) {
  const SceneView view = view_of({segment({-1.0, -1.0, -1.0}, {-0.9, -1.0, -1.0})});
  const double depth = shown(view, view.camera.focal_point).z;
  const Vec3 found = shown(view, start_at(view, 500.0, 100.0));
  EXPECT_NEAR(found.x, 500.0, 1e-6);
  EXPECT_NEAR(found.y, 100.0, 1e-6);
  EXPECT_NEAR(found.z, depth, 1e-9 * depth);
}

TEST(StartOfProbe, NearALineItIsThePlaceOfTheLineThatLooksNearest) {
  const SceneView view =
      view_of({segment({-0.8, 0.3, 0.9}, {0.9, -0.2, -0.7}), segment({0.0, 0.9, 0.9}, {0.1, 0.8, 0.9})});
  const Line& line = view.lines->front();
  for (const double x : {300.0, 400.0, 470.0}) {
    const double y = 330.0;
    const Vec3 found = shown(view, start_at(view, x, y));
    double nearest = HUGE_VAL;  // over points of the picture's line: brute force
    const Vec3 a = shown(view, line.points[0].position), b = shown(view, line.points[1].position);
    for (int i = 0; i <= 100'000; ++i) {
      const Vec3 p = glm::mix(a, b, 1e-5 * i);
      nearest = std::min(nearest, std::hypot(p.x - x, p.y - y));
    }
    ASSERT_LT(nearest, 150.0) << "the mouse has to be near the line";
    // What divides the segment in the picture divides it otherwise in space, by perspective: the place is on
    // the line, and a little off the nearest point.
    EXPECT_NEAR(std::hypot(found.x - x, found.y - y), nearest, 0.06 * nearest + 1.0);
  }
}

TEST(StartOfProbe, WhereLinesCrossInThePictureItIsOnTheOneInFront) {
  const SceneView empty = view_of({});
  const Vec3 back = empty.camera.axes[2];  // towards the viewer
  const Vec3 right = empty.camera.axes[0], up = empty.camera.axes[1];
  const Vec3 middle = empty.camera.focal_point;
  const Line front = segment(middle + 0.5 * back - 0.5 * right, middle + 0.5 * back + 0.5 * right);
  const Line behind = segment(middle - 0.5 * back - 0.5 * up, middle - 0.5 * back + 0.5 * up);
  for (const auto& lines : {std::vector{front, behind}, std::vector{behind, front}}) {
    const SceneView view = view_of(lines);
    const Vec3 found = start_at(view, 400.4, 299.5);
    EXPECT_NEAR(glm::dot(found - middle, back), 0.5, 0.01);
  }
}

}  // namespace
}  // namespace palpate
