// A lens on a layer, and what of a surface is seen under the mouse.
#include "common/window/controls/color_lens_control.h"

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "common/render/camera.h"
#include "common/window/controls/pick_volume.h"

namespace palpate {
namespace {

constexpr PictureArea kWide{100.0, 0.0, 400.0, 400.0};

/// Two squares across the view, at 0.5 and -0.5 towards the viewer; a cut has left the second one alone.
SceneView cut_view() {
  SceneView view;
  view.bounds = {Vec3{-1.0}, Vec3{1.0}};
  view.camera = make_camera(view.bounds, {.azimuth = 20.0, .elevation = 30.0}, 1.0, Projection::kPerspective);
  const Vec3 &right = view.camera.axes[0], &up = view.camera.axes[1], &back = view.camera.axes[2];
  auto mesh = std::make_shared<IsosurfaceMesh>();
  for (const double depth : {0.5, -0.5})
    for (const auto& [x, y] : {std::pair{-0.9, -0.9}, {0.9, -0.9}, {0.9, 0.9}, {-0.9, 0.9}})
      mesh->points.push_back(x * right + y * up + depth * back);
  mesh->triangles = {{4, 5, 6}, {4, 6, 7}};
  mesh->normals.resize(mesh->points.size());
  const auto values = std::make_shared<const std::vector<float>>(mesh->points.size());
  view.surfaces = {{.mesh = mesh, .values = values, .lens_values = values}};
  return view;
}

TEST(ColorLensControl, IsPutOnWhatACutHasLeftOfTheLayer) {
  SceneView view = cut_view();
  ColorLens lens;
  place_lens(view, lens);
  EXPECT_NEAR(glm::dot(lens.center, view.camera.axes[2]), -0.5, 1e-12);
  view.color_lens = lens;
  ColorLensControl control;
  control.follow(true);
  const Vec3 there = 0.2 * view.camera.axes[0] - 0.3 * view.camera.axes[1] - 0.5 * view.camera.axes[2];
  const Vec3 shown = project(view.camera, there, 400, 400);
  EXPECT_FALSE(
      control.handle({.kind = InputKind::kMove, .x = kWide.left + shown.x, .y = shown.y}, kWide, view));
  EXPECT_LT(glm::distance(view.color_lens->center, there), 1e-9);
  // Beside the layer it stays.
  EXPECT_FALSE(control.handle({.kind = InputKind::kMove, .x = kWide.left + 1.0, .y = 1.0}, kWide, view));
  EXPECT_LT(glm::distance(view.color_lens->center, there), 1e-9);
}

TEST(PickSurface, IsTheNearestTriangleOfThoseThatCount) {
  SceneView view = cut_view();
  auto front = std::make_shared<IsosurfaceMesh>(*view.surfaces[0].mesh);
  front->triangles = {{0, 1, 2}, {0, 2, 3}};
  view.surfaces.push_back({.mesh = front, .opacity = 0.25});
  view.surfaces.push_back({});
  const Vec3& back = view.camera.axes[2];
  const auto at = [&](const Vec3& x) {
    const Vec3 shown = project(view.camera, x, 400, 400);
    return view_ray(view.camera, {400, 400}, {shown.x, shown.y});
  };
  const auto all = pick_surface(at(Vec3(0.0)), view.surfaces, [](const SurfaceView&) { return true; });
  ASSERT_TRUE(all);
  EXPECT_NEAR(glm::dot(*all, back), 0.5, 1e-9);
  const auto colored =
      pick_surface(at(Vec3(0.0)), view.surfaces, [](const SurfaceView& surface) { return !!surface.values; });
  ASSERT_TRUE(colored);
  EXPECT_NEAR(glm::dot(*colored, back), -0.5, 1e-9);
  EXPECT_FALSE(pick_surface({.from = 5.0 * back, .along = back}, view.surfaces, [](const SurfaceView&) {
    return true;
  })) << "behind the viewer";
  EXPECT_FALSE(
      pick_surface(at(2.0 * view.camera.axes[0]), view.surfaces, [](const SurfaceView&) { return true; }));
}

}  // namespace
}  // namespace palpate
