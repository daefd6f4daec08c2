// Pictures of isosurfaces: lit triangles that hide and are hidden, kept beside the tests and looked at.

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/volume_examples.h"
#include "tests/common/render/picture_checks.h"
#include "tests/support/torus_scalar.h"

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

/// The ball, coloured by x from -0.8 to 0.8, blue to red.
SceneView colored_ball() {
  SceneView view = ball_view();
  view.style.color_by = ColorBy::kArray;
  view.style.array = std::make_shared<const LineArray>();
  view.style.range = ValueRange{-0.8, 0.8};
  view.style.color_map = ColorMap::kDiverging;
  std::vector<float> values;
  for (const Vec3& x : view.surfaces[0].mesh->points) values.push_back(static_cast<float>(x.x));
  view.surfaces[0].values = std::make_shared<const std::vector<float>>(values);
  return view;
}

/// How much more red than blue.
int redness(const std::array<int, 4>& pixel) { return pixel[0] - pixel[2]; }

TEST(SurfacePicture, ValuesColourIt) {
  SceneView view = colored_ball();
  const Image image = render_image(view, kSize, kSize).image;
  EXPECT_GT(redness(at(image, 0.6, 0.0)), 40);
  EXPECT_LT(redness(at(image, -0.6, 0.0)), -40);
  EXPECT_LT(std::abs(redness(at(image, 0.0, 0.0))), 25);
  // Where there is no number it is grey.
  view.surfaces[0].values =
      std::make_shared<const std::vector<float>>(view.surfaces[0].mesh->points.size(), std::nanf(""));
  EXPECT_LT(std::abs(redness(at(render_image(view, kSize, kSize).image, 0.6, 0.0))), 12);
}

TEST(SurfacePicture, LinesOfEqualValueLieAtItsMultiples) {
  SceneView view = colored_ball();
  const Image plain = render_image(view, kSize, kSize).image;
  view.surfaces[0].contours = 0.25;
  const Image image = render_image(view, kSize, kSize).image;
  for (int y = -3; y <= 3; ++y) {
    for (const double x : {-0.5, -0.25, 0.0, 0.25, 0.5}) {
      EXPECT_NE(at(image, x, 0.1 * y), at(plain, x, 0.1 * y)) << x << " " << y;
      EXPECT_EQ(at(image, x + 0.125, 0.1 * y), at(plain, x + 0.125, 0.1 * y)) << x << " " << y;
    }
  }
}

// A ball of radius 0.3 about the middle of the front, which shows z in place of x.
TEST(SurfacePicture, ALensShowsOtherValuesWithinItsBall) {
  SceneView view = colored_ball();
  const Image plain = render_image(view, kSize, kSize).image;
  std::vector<float> inside;
  for (const Vec3& x : view.surfaces[0].mesh->points) inside.push_back(static_cast<float>(4.0 * x.z));
  view.surfaces[0].lens_values = std::make_shared<const std::vector<float>>(inside);
  view.color_lens = ColorLens{.center = {0.0, -0.8, 0.0}, .radius = 0.3, .style = view.style};
  const Image image = render_image(view, kSize, kSize).image;
  EXPECT_GT(redness(at(image, 0.0, 0.2)), 40);
  EXPECT_LT(redness(at(image, 0.0, -0.2)), -40);
  for (const auto& [x, z] :
       {std::pair{0.34, 0.0}, std::pair{-0.34, 0.0}, std::pair{0.0, 0.34}, std::pair{0.5, 0.5}})
    EXPECT_EQ(at(image, x, z), at(plain, x, z)) << "beside it nothing changes";
  // Lines, too.
  Line line = across(0.1, -0.81);
  view.lines = std::make_shared<const std::vector<Line>>(std::vector{line});
  const auto array_of = [&](double value) {
    auto array = std::make_shared<LineArray>();
    array->values.assign(line.points.size(), static_cast<float>(value));
    return array;
  };
  view.style.array = array_of(0.8);
  view.color_lens->style.array = array_of(-0.8);
  const Image with_line = render_image(view, kSize, kSize).image;
  EXPECT_LT(redness(at(with_line, 0.1, 0.1)), -40) << "inside";
  EXPECT_GT(redness(at(with_line, 0.5, 0.1)), 40) << "outside";
  expect_baseline(view, "surface_lens");
}

}  // namespace
}  // namespace palpate::test
