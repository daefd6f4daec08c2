// Pictures of a ProbeView: what hides what, and that drawing only what moves gives the same picture.
#include <array>
#include <cmath>
#include <memory>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "common/render/gl/context.h"
#include "common/render/render_image.h"
#include "common/render/scene_renderer.h"
#include "tests/common/render/picture_checks.h"
#include "tests/common/render/sample_probe.h"
#include "tests/support/lab_color.h"
#include "tests/support/path_view.h"

namespace palpate {
namespace {

using test::kSize;

// A ribbon along x at y = -0.5, red, and a ball that is not: plain, of radius 0.3 at the depth y.
SceneView ribbon_and_ball(double y) {
  SceneView view = test::front_view({test::polyline({{-0.8, -0.5, 0.0}, {0.8, -0.5, 0.0}})});
  view.style.color_by = ColorBy::kDirection;
  view.style.halo = false;
  auto followed = std::make_shared<FollowedLine>();
  followed->balls = {Vec3(0.0, y, 0.0)};
  followed->ball_radius = 0.3;
  ProbeView probe;
  probe.followed = followed;
  probe.style.see_through = 0.0;
  view.probe = probe;
  return view;
}

bool is_red(const std::array<int, 4>& c) { return c[0] > c[1] + 60 && c[0] > c[2] + 60; }
bool is_ball(const std::array<int, 4>& c) { return c[0] > 60 && std::abs(c[0] - c[2]) < 40; }

TEST(ProbePicture, NearerRibbonHidesTheBall) {
  const Image image = render_image(ribbon_and_ball(0.5), kSize, kSize).image;
  EXPECT_TRUE(is_red(test::at(image, 0.0, 0.0)));
  EXPECT_TRUE(is_red(test::at(image, 0.2, 0.0)));
  EXPECT_TRUE(is_ball(test::at(image, 0.0, 0.2)));
}

TEST(ProbePicture, NearerBallHidesTheRibbon) {
  const Image image = render_image(ribbon_and_ball(-0.85), kSize, kSize).image;
  EXPECT_TRUE(is_ball(test::at(image, 0.0, 0.0)));
  EXPECT_TRUE(is_ball(test::at(image, 0.25, 0.0)));
  EXPECT_TRUE(is_red(test::at(image, 0.5, 0.0)));
}

// The centre lies behind the ribbon, the front of the ball before it: they cross where the surface is at
// y = -0.5, at sqrt(0.3^2 - 0.2^2) = 0.224 from the middle.
TEST(ProbePicture, BallAndRibbonCrossWhereTheyMeet) {
  const Image image = render_image(ribbon_and_ball(-0.3), kSize, kSize).image;
  EXPECT_TRUE(is_ball(test::at(image, 0.19, 0.0)));
  EXPECT_TRUE(is_red(test::at(image, 0.26, 0.0)));
  EXPECT_TRUE(is_ball(test::at(image, -0.19, 0.0)));
  EXPECT_TRUE(is_red(test::at(image, -0.26, 0.0)));
}

TEST(ProbePicture, SilhouetteHasTheRadiusOfTheBall) {
  SceneView view = ribbon_and_ball(0.0);
  view.lines = nullptr;
  const Image image = render_image(view, kSize, kSize).image;
  int lit = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) lit += test::is_background(image.pixel(x, y)) ? 0 : 1;
  }
  const double radius = 0.3 * kSize / 2.44;
  // Pixels that the border crosses count where enough of them is lit: within half a pixel of the radius.
  EXPECT_NEAR(std::sqrt(lit / 3.14159265), radius, 0.5);
}

TEST(ProbePicture, HiddenBallShinesThrough) {
  SceneView view = ribbon_and_ball(0.5);
  const auto hidden = test::at(render_image(view, kSize, kSize).image, 0.0, 0.0);
  view.probe->style.see_through = 0.5;
  const auto mixed = test::at(render_image(view, kSize, kSize).image, 0.0, 0.0);
  EXPECT_GT(mixed[2], hidden[2] + 30);
  view.probe->followed = nullptr;
  EXPECT_EQ(test::at(render_image(view, kSize, kSize).image, 0.0, 0.0), hidden);
}

// A wall before a kept line, opaque or translucent, dims it and does not hide it.
TEST(ProbePicture, KeptLineShinesThroughAWall) {
  auto wall = std::make_shared<IsosurfaceMesh>();
  for (const auto& [x, z] : {std::pair{-0.9, -0.9}, {0.9, -0.9}, {0.9, 0.9}, {-0.9, 0.9}})
    wall->points.emplace_back(x, -0.5, z);
  wall->normals.assign(4, Vec3f(0.0F, -1.0F, 0.0F));
  wall->triangles = {{0, 1, 2}, {0, 2, 3}};
  auto kept = std::make_shared<std::vector<DrawnLine>>();
  kept->push_back({.line = std::make_shared<const Line>(test::polyline({{-0.7, 0.5, 0.0}, {0.7, 0.5, 0.0}})),
                   .number = 0,
                   .color = Rgb(0.1F, 0.9F, 0.1F)});
  for (const double opacity : {1.0, 0.45}) {
    SceneView view = test::front_view({test::polyline({{-0.8, 0.8, 0.8}, {0.8, 0.8, 0.8}})});
    view.surfaces = {{.mesh = wall, .color = {0.88F, 0.3F, 0.3F}, .opacity = opacity}};
    view.probe = ProbeView();
    view.probe->style.kept_width = 40.0;
    const auto green = [&view] {
      const auto c = test::at(render_image(view, kSize, kSize).image, 0.0, 0.0);
      return c[1] - c[0];
    };
    const int without = green();
    view.probe->drawn_lines = kept;
    const int dimmed = green();
    view.probe->style.see_through = 0.0;
    EXPECT_GT(dimmed, without + 80) << opacity;
    EXPECT_GT(dimmed, green() + 50) << opacity;
  }
}

// One bar means one thing: a rake has the colours that the scene's lines have for the same number, and where
// that number is not known of it none of the bar's.
TEST(ProbePicture, RakeIsColouredLikeTheLinesOfTheScene) {
  const auto heat = [](const std::string& name, double least, double most, std::size_t count) {
    auto array = std::make_shared<LineArray>();
    array->name = name;
    for (std::size_t i = 0; i < count; ++i)
      array->values.push_back(
          static_cast<float>(std::lerp(least, most, static_cast<double>(i) / (count - 1))));
    return array;
  };
  // Along the upper line from 300 to 400; the rake's line, below it, is 400 all along, and slow throughout.
  SceneView view = test::front_view({test::polyline({{-0.8, 0.0, 0.5}, {0.0, 0.0, 0.5}, {0.8, 0.0, 0.5}})});
  view.style.color_by = ColorBy::kArray;
  view.style.array = heat("Temp", 300.0, 400.0, 3);
  view.style.halo = view.show_color_bar = false;
  view.style.width = 40.0;
  auto seeds = std::make_shared<LocalSeeds>();
  seeds->lines = std::make_shared<const std::vector<Line>>(
      std::vector<Line>{test::polyline({{-0.8, 0.0, -0.5}, {0.8, 0.0, -0.5}})});
  seeds->width = 40.0;
  seeds->array = heat("Temp", 400.0, 400.0, 2);
  ProbeView probe;
  probe.seeds = seeds;
  view.probe = probe;
  const auto shown = [&](const ColorMap map) {
    view.style.color_map = map;
    return render_image(view, kSize, kSize).image;
  };
  const auto difference = [](const std::array<int, 4>& a, const std::array<int, 4>& b) {
    return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
  };
  for (const ColorMap map : {ColorMap::kSequential, ColorMap::kHeat}) {
    const Image image = shown(map);
    const auto hot = test::at(image, 0.78, 0.5), cold = test::at(image, -0.78, 0.5);
    ASSERT_GT(difference(hot, cold), 150);
    EXPECT_LT(difference(test::at(image, -0.7, -0.5), hot), 30);
    EXPECT_LT(difference(test::at(image, 0.7, -0.5), hot), 30);
  }
  const auto plain = [&] {
    const auto c = test::at(shown(ColorMap::kHeat), 0.0, -0.5);
    return std::max({c[0], c[1], c[2]}) - std::min({c[0], c[1], c[2]}) < 25;
  };
  EXPECT_FALSE(plain());
  auto other = std::make_shared<LocalSeeds>(*seeds);
  other->array = heat("Pres", 400.0, 400.0, 2);
  view.probe->seeds = other;
  EXPECT_TRUE(plain()) << "another array";
  other = std::make_shared<LocalSeeds>(*seeds);
  other->array = nullptr;
  view.probe->seeds = other;
  EXPECT_TRUE(plain()) << "no array";
  view.style.color_by = ColorBy::kSeed;
  EXPECT_TRUE(plain()) << "no seed of the scene's";
}

// Transparent lines are drawn last, over what lies behind them.
TEST(ProbePicture, TransparentRibbonMixesWithTheBallBehindIt) {
  SceneView view = ribbon_and_ball(0.5);
  view.style.opacity = 0.5;
  const Image image = render_image(view, kSize, kSize).image;
  const auto both = test::at(image, 0.0, 0.0), ribbon = test::at(image, 0.5, 0.0),
             ball = test::at(image, 0.0, 0.2);
  EXPECT_TRUE(is_ball(ball));
  EXPECT_TRUE(is_red(ribbon));
  EXPECT_GT(both[2], ribbon[2] + 40);  // the ball is seen through the ribbon
  EXPECT_LT(both[2], ball[2] - 40);    // which takes away half of its blue
}

TEST(ProbePicture, ProbeThatIsNotFiniteDrawsNothing) {
  SceneView view = test::whirlwind(1.0, 20);
  const Image without = render_image(view, kSize, kSize).image;
  ProbeView probe;
  probe.probe = Vec3(NAN, 0.0, 0.0);
  probe.proxy = Vec3(0.0, HUGE_VAL, 0.0);
  probe.force = std::nan("");
  probe.force_cap = 2.0;
  probe.velocity = Vec3(NAN);
  probe.reference_speed = 1.0;
  auto followed = std::make_shared<FollowedLine>();
  followed->points = {Vec3(NAN), Vec3(0.0, NAN, 0.0)};
  followed->values = {NAN, 1.0};
  followed->balls = {Vec3(NAN)};
  probe.followed = followed;
  view.probe = probe;
  EXPECT_EQ(render_image(view, kSize, kSize).image.rgba, without.rgba);
}

// The hand may leave the box that the picture was fitted to, to the front and to the back.
TEST(ProbePicture, ProbeOutsideTheDomainIsSeen) {
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    for (const double y : {-2.2, 0.0, 30.0}) {
      SceneView view = test::front_view({});
      view.camera.projection = projection;
      view.probe = ProbeView{.probe = Vec3(0.0, y, 0.0)};
      view.probe->style.probe_size = 60.0;
      EXPECT_FALSE(test::is_background(test::at(render_image(view, kSize, kSize).image, 0.0, 0.0))) << y;
    }
  }
}

SceneView scene_with_probe() {
  SceneView view = test::whirlwind(1.0, 20);
  view.probe = test::sample_probe(view, 100);
  return view;
}

// How a hand moves: the probe every picture, the path with it, now and then another line, camera or path.
std::vector<SceneView> course_of_events() {
  SceneView view = scene_with_probe();
  auto path = std::make_shared<ProbePath>();
  view.probe->path = {};
  std::vector<SceneView> course;
  const auto step = [&](int points) {
    for (int i = 0; i < points; ++i) {
      const double t = static_cast<double>(path->size());
      path->append({0.5 * std::cos(0.2 * t), 0.5 * std::sin(0.2 * t), -0.8 + 0.01 * t}, 0.02 * t);
    }
    view.probe->proxy.z += 0.01;
    view.probe->probe += Vec3(0.02, -0.02, 0.01);
    view.probe->path.points = path;
    view.probe->path.count = path->size();
    course.push_back(view);
  };
  for (const int points : {0, 1, 1, 1, 7, 0, 30}) step(points);
  path->append(Vec3(NAN), 0.0);
  for (const int points : {1, 1, 5}) step(points);
  view.probe->followed = test::followed_of((*view.lines)[3], 12);
  step(3);
  view.probe->seeds = nullptr;
  step(2);
  turn(view.camera, 0.3, -0.1);
  step(2);
  view.probe->path.range = ValueRange{0.0, 0.5};
  step(2);
  view.style.opacity = 0.5;  // transparent lines mix with the probe
  step(2);
  step(2);
  view.style.opacity = 1.0;
  view.background = Background::kLight;
  step(1);
  path = std::make_shared<ProbePath>();
  step(4);
  SceneView without = view;
  without.probe.reset();
  course.push_back(without);
  step(2);
  SceneView back = view;  // as when a recording is wound back
  back.probe->path.count = 2;
  course.push_back(back);
  return course;
}

TEST(LocalRedraw, GivesThePictureOfAFullRedraw) {
  const OffscreenContext context;
  SceneRenderer kept;
  int number = 0;
  for (const SceneView& view : course_of_events()) {
    kept.draw(view, kSize, kSize);
    SceneRenderer fresh;
    fresh.draw(view, kSize, kSize);
    const Image image = kept.read();
    ASSERT_LE(test::worst_difference(image, fresh.read()), 1) << number;
    test::cache_picture(image, "course_" + std::to_string(number));
    ++number;
  }
}

TEST(LocalRedraw, AtAnotherSizeOrResolutionToo) {
  const OffscreenContext context;
  SceneRenderer kept;
  const SceneView view = scene_with_probe();
  for (const auto& [width, height, resolution] :
       {std::tuple{200, 150, 1.0}, {200, 150, 0.5}, {200, 150, 1.0}, {120, 150, 1.0}}) {
    kept.draw(view, width, height, resolution);
    SceneRenderer fresh;
    fresh.draw(view, width, height, resolution);
    ASSERT_LE(test::worst_difference(kept.read(), fresh.read()), 1) << width << " " << resolution;
  }
}

TEST(LocalRedraw, PathThatGrewIsThatUploadedInOneGo) {
  const OffscreenContext context;
  SceneView view = scene_with_probe();
  view.probe->style.path_width = 20.0;
  auto path = std::make_shared<ProbePath>();
  SceneRenderer grown;
  // Past the first room of the buffer, which is for 1024 points.
  for (int i = 0; i < 1500; ++i) {
    const double t = 0.01 * i;
    path->append({(0.3 + 0.04 * t) * std::cos(3.0 * t), (0.3 + 0.04 * t) * std::sin(3.0 * t), 0.1 * t - 0.7},
                 1.0 + std::sin(t));
    if (i % 400 == 399) path->append(Vec3(NAN), 0.0);
    if (i % 37 != 0) continue;
    view.probe->path = {path, path->size(), {}};
    grown.draw(view, kSize, kSize);
  }
  view.probe->path = {path, path->size(), {}};
  grown.draw(view, kSize, kSize);
  SceneRenderer at_once;
  at_once.draw(view, kSize, kSize);
  EXPECT_EQ(test::worst_difference(grown.read(), at_once.read()), 0);

  // And it is there: yellow to red, which nothing else is.
  view.probe->path = {};
  at_once.draw(view, kSize, kSize);
  EXPECT_GT(test::mean_difference(grown.read(), at_once.read()), 1.0);
}

TEST(ProbePicture, PathIsColouredByForce) {
  SceneView view = test::front_view({});
  view.probe = ProbeView{.force_cap = 4.0};
  view.probe->style.path_width = 60.0;
  std::vector<Vec3> positions;
  std::vector<double> forces;
  for (int i = 0; i <= 10; ++i) {
    positions.emplace_back(-0.9 + 0.18 * i, 0.0, 0.0);
    forces.push_back(0.4 * i);
  }
  view.probe->path = test::make_path_view(positions, forces);
  const Image image = render_image(view, kSize, kSize).image;
  for (const double t : {0.1, 0.5, 0.9}) {
    const auto pixel = test::at(image, -0.9 + 1.8 * t, 0.0);
    const Vec3 found = test::lab_from_srgb(Vec3(pixel[0], pixel[1], pixel[2]) / 255.0);
    const Vec3 expected = test::lab_from_srgb(Vec3(map_color(ColorMap::kTension, t)));
    EXPECT_NEAR(std::atan2(found.z, found.y), std::atan2(expected.z, expected.y), 0.15) << t;
  }
}

// A kept line is a copy of one that is drawn already, and the path lies on the followed line.
TEST(ProbePicture, LinesAlongOneCurveAreSeenInTheirOrder) {
  const std::vector<Vec3> points{{-0.7, -0.5, -0.4}, {0.7, 0.6, 0.5}};
  const Line line = test::polyline(points);
  SceneView view = test::front_view({line});
  view.camera = make_camera(view.bounds, {.azimuth = 17.0, .elevation = 11.0}, 1.0);
  view.style.color_by = ColorBy::kUniform;
  view.style.width = 12.0;
  ProbeView probe{.force_cap = 1.0};
  const auto greens = [&](double from, double to) {
    view.probe = probe;
    const Image image = render_image(view, kSize, kSize).image;
    int count = 0;
    for (int i = 0; i <= 100; ++i) {
      const Vec3 p =
          project(view.camera, glm::mix(points[0], points[1], from + (to - from) * i / 100.0), kSize, kSize);
      const auto c = image.pixel(static_cast<int>(p.x), static_cast<int>(p.y));
      count += c[1] > c[0] + 40 && c[1] > c[2] + 40 ? 1 : 0;
    }
    return count;
  };
  probe.style.kept_width = 12.0;
  auto kept = std::make_shared<std::vector<DrawnLine>>();
  kept->push_back({.line = std::make_shared<const Line>(line), .number = 0, .color = Rgb(0.1F, 0.9F, 0.1F)});
  probe.drawn_lines = kept;
  EXPECT_EQ(greens(0.05, 0.95), 101);
  probe.drawn_lines = nullptr;
  probe.style.followed_width = 50.0;
  probe.style.path_width = 25.0;
  auto followed = std::make_shared<FollowedLine>();
  followed->points = points;
  probe.followed = followed;
  // The path is there for one half, yellow: as much red as green, and the followed line is grey beside it.
  probe.path =
      test::make_path_view(std::array{points[0], 0.5 * (points[0] + points[1])}, std::array{0.0, 0.0});
  view.probe = probe;
  const Image image = render_image(view, kSize, kSize).image;
  for (const auto& [t, yellow] :
       {std::pair{0.1, true}, {0.25, true}, {0.4, true}, {0.6, false}, {0.8, false}}) {
    const Vec3 p = project(view.camera, glm::mix(points[0], points[1], t), kSize, kSize);
    const auto c = image.pixel(static_cast<int>(p.x), static_cast<int>(p.y));
    EXPECT_EQ(c[0] > c[2] + 60, yellow) << t;
  }
}

TEST(ProbePicture, PathHasNoBridgeAcrossAGap) {
  SceneView view = test::front_view({});
  view.probe = ProbeView{.force_cap = 1.0};
  view.probe->style.path_width = 40.0;
  std::vector<Vec3> positions{
      {-0.8, 0.0, 0.0}, {-0.4, 0.0, 0.0}, Vec3(NAN), {0.4, 0.0, 0.0}, {0.8, 0.0, 0.0}};
  view.probe->path = test::make_path_view(positions, std::vector<double>(positions.size(), 0.5));
  const Image image = render_image(view, kSize, kSize).image;
  EXPECT_TRUE(test::is_background(test::at(image, 0.0, 0.0)));
  EXPECT_FALSE(test::is_background(test::at(image, -0.6, 0.0)));
  EXPECT_FALSE(test::is_background(test::at(image, 0.6, 0.0)));
}

TEST(ProbePicture, NewtonsNumbersAndTheSecondBarLeaveTheirMarks) {
  SceneView view = test::front_view({});
  view.probe = ProbeView{};
  const auto lit = [&](int x0, int x1, int y0, int y1) {
    const Image image = render_image(view, kSize, kSize).image;
    int count = 0;
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) count += test::is_background(image.pixel(x, y)) ? 0 : 1;
    }
    return count;
  };
  EXPECT_EQ(lit(0, kSize, 0, kSize), 0);

  // A kept line of one point is nothing but its number.
  auto kept = std::make_shared<std::vector<DrawnLine>>();
  kept->push_back({.line = std::make_shared<const Line>(test::polyline({{-0.5, 0.0, 0.5}})), .number = 8});
  view.probe->drawn_lines = kept;
  EXPECT_GT(lit(50, 80, 40, 70), 8);
  view.probe->drawn_lines = nullptr;

  view.probe->probe = view.probe->proxy = Vec3(0.0);
  view.probe->style.probe_size = view.probe->style.proxy_size = 0.1;
  view.probe->force_cap = 2.0;
  view.probe->force = 1.25;
  const int newtons = lit(100, 160, 95, 125);
  EXPECT_GT(newtons, 40);
  view.probe->show_force = false;
  EXPECT_LT(lit(100, 160, 95, 125), newtons - 40);

  view.show_color_bar = true;
  EXPECT_EQ(lit(150, kSize, 100, kSize), 0);
  view.probe->path = test::make_path_view(std::array{Vec3(0.0), Vec3(0.01, 0.0, 0.0)}, std::array{0.0, 1.0});
  EXPECT_GT(lit(150, kSize, 100, kSize), 300);
}

TEST(Baseline, ProbeInTheWhirlwind) {
  SceneView view = test::whirlwind(4.0 / 3.0, 24);
  view.show_axes = view.show_color_bar = false;
  view.style.width = 6.0;
  view.probe = test::sample_probe(view);
  // Without text: which font there is depends on the system.
  view.probe->show_force = false;
  auto kept = *view.probe->drawn_lines;
  for (DrawnLine& line : kept) {
    line.color = cached_color(line.number);
    line.number = 0;
  }
  view.probe->drawn_lines = std::make_shared<const std::vector<DrawnLine>>(std::move(kept));
  test::expect_baseline(view, "probe_dark");
}

}  // namespace
}  // namespace palpate
