// Pictures of isosurfaces: lit triangles that hide and are hidden, kept beside the tests and looked at.

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/scalar_examples.h"
#include "tests/common/render/picture_checks.h"

namespace palpate::test {
namespace {

std::shared_ptr<const IsosurfaceMesh> mesh_of(const std::shared_ptr<const AnalyticScalar>& scalar,
                                              double level) {
  constexpr std::size_t kPlenty = 200'000;
  return std::make_shared<IsosurfaceMesh>(make_isosurface_mesh(*make_scalar_field(scalar), level, kPlenty));
}

/// A ball of radius 0.8 from the front, and perhaps another thing.
SceneView ball_view() {
  SceneView view = front_view({});
  view.surfaces = show_surfaces({mesh_of(sphere_scalar(), 0.64)});
  return view;
}

Line across(double z, double y) {
  Line line;
  for (int i = 0; i <= 20; ++i) {
    LinePoint point;
    point.position = {-1.0 + 0.1 * i, y, z};
    line.points.push_back(point);
  }
  return line;
}

TEST(SurfacePicture, ABallIsRoundLitFromTheLeftAndOpaque) {
  const Image image = render_image(ball_view(), kSize, kSize).image;
  EXPECT_FALSE(is_background(at(image, 0.0, 0.0)));
  EXPECT_FALSE(is_background(at(image, 0.55, 0.55)));
  EXPECT_TRUE(is_background(at(image, 0.62, 0.62))) << "beyond the radius";
  EXPECT_TRUE(is_background(at(image, 0.9, 0.0)));
  const auto left = at(image, -0.35, 0.35), right = at(image, 0.55, -0.45);
  EXPECT_GT(left[0], right[0] + 40) << "the light is above the left shoulder";
}

TEST(SurfacePicture, LinesBehindItAreHiddenAndThoseInFrontAreNot) {
  SceneView view = ball_view();
  view.style.color_by = ColorBy::kUniform;
  const Image alone = render_image(view, kSize, kSize).image;
  view.lines = std::make_shared<const std::vector<Line>>(std::vector{across(0.0, 0.95)});
  const Image behind = render_image(view, kSize, kSize).image;
  EXPECT_EQ(at(behind, 0.0, 0.0), at(alone, 0.0, 0.0));
  EXPECT_NE(at(behind, 0.9, 0.0), at(alone, 0.9, 0.0)) << "beside the ball it is seen";
  view.lines = std::make_shared<const std::vector<Line>>(std::vector{across(0.0, -0.95)});
  EXPECT_NE(at(render_image(view, kSize, kSize).image, 0.0, 0.0), at(alone, 0.0, 0.0));
}

TEST(SurfacePicture, NestedOnesAreSeenThroughEachOther) {
  SceneView view = front_view({});
  const auto inner = mesh_of(sphere_scalar(), 0.16), outer = mesh_of(sphere_scalar(), 0.64);
  view.surfaces = show_surfaces({outer});
  const auto outer_alone = at(render_image(view, kSize, kSize).image, 0.1, 0.1);
  view.surfaces = show_surfaces({inner, outer});
  const Image both = render_image(view, kSize, kSize).image;
  EXPECT_NE(at(both, 0.1, 0.1), at(both, 0.6, 0.1)) << "the inner one shows";
  EXPECT_NE(at(both, 0.1, 0.1), outer_alone);
}

TEST(SurfacePicture, NothingIsDrawnOfWhatIsNotThere) {
  SceneView view = ball_view();
  view.surfaces = {SurfaceView{}, SurfaceView{.mesh = std::make_shared<IsosurfaceMesh>()}};
  EXPECT_TRUE(is_background(at(render_image(view, kSize, kSize).image, 0.0, 0.0)));
}

TEST(SurfacePicture, Torus) {
  SceneView view = front_view({});
  view.camera = make_camera(view.bounds, {}, 4.0 / 3.0);
  view.surfaces = show_surfaces({mesh_of(torus_scalar(), 0.09)});
  expect_baseline(view, "surface_torus");
}

TEST(SurfacePicture, WithTheProbeOnIt) {
  SceneView view = ball_view();
  view.camera = make_camera(view.bounds, {}, 4.0 / 3.0);
  view.probe.emplace();
  view.probe->proxy = {0.0, -0.8, 0.0};
  view.probe->probe = {0.1, -0.65, 0.1};
  view.probe->force = 2.0;
  view.probe->force_cap = 4.0;
  expect_baseline(view, "surface_probe");
}

}  // namespace
}  // namespace palpate::test
