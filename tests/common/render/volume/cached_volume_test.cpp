// Local rendering: the picture with a volume that is kept while opaque things move in it is that of a full
// redraw, and what lies in a volume is veiled by what is before it.

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/render/gl/context.h"
#include "common/render/scene_renderer.h"
#include "tests/common/render/picture_checks.h"
#include "tests/common/render/volume/sample_volumes.h"

namespace palpate::test {
namespace {

constexpr int kWidth = 150, kHeight = 130;

/// A line on the way of the hand, which stays in the picture.
std::shared_ptr<const ProbePath> path_of(int points) {
  auto path = std::make_shared<ProbePath>();
  for (int i = 0; i < points; ++i)
    path->append({-0.7 + 0.05 * i, 0.3 * std::sin(0.4 * i), -0.5 + 0.04 * i}, 0.1 * i);
  return path;
}

/// Blobs with a hand among them: a probe, a proxy, a band, an arrow, a line that it follows and its path.
SceneView scene_of(Projection projection) {
  SceneView view;
  view.volume = sampled_view(blobs);
  view.volume->transfer = ColorTransfer({{0.4, {0.9F, 0.5F, 0.2F}, 0.0}, {0.7, {0.3F, 0.6F, 1.0F}, 0.12}});
  view.bounds = view.volume->image->bounds();
  view.camera = make_camera(view.bounds, {.azimuth = 25.0, .elevation = 15.0}, 1.15, projection);
  view.show_axes = view.show_color_bar = false;
  ProbeView probe{.probe = {0.5, -0.3, 0.1}, .proxy = {0.2, 0.1, 0.0}, .force = 1.0, .force_cap = 2.0};
  probe.show_force = false;
  probe.velocity = {0.3, 0.2, 0.1};
  probe.reference_speed = 0.3;
  probe.style.probe_size = probe.style.proxy_size = 60.0;
  auto followed = std::make_shared<FollowedLine>();
  for (int i = 0; i <= 40; ++i) followed->points.emplace_back(-0.9 + 0.045 * i, 0.2 * std::cos(0.3 * i), 0.2);
  followed->balls = {Vec3(-0.4, 0.1, 0.2)};
  probe.followed = followed;
  view.probe = probe;
  view.volume->cache_picture = true;
  return view;
}

/// What moves a hand: the probe each picture, the path that grows, another outline, another line.
std::vector<SceneView> course(SceneView view) {
  std::vector<SceneView> all;
  for (int i = 0; i < 6; ++i) {
    view.probe->probe += Vec3(-0.12, 0.1, 0.05);
    view.probe->proxy += Vec3(0.05, -0.06, 0.03);
    if (i >= 2) {
      const auto path = path_of(4 * i);
      view.probe->path = {path, path->size(), {}};
    }
    if (i == 4) {
      view.outline = {{Vec3(-0.9, -0.9, 0.1), Vec3(0.9, -0.2, 0.1), Vec3(0.4, 0.9, 0.3)}};
      view.probe->followed.reset();
    }
    all.push_back(view);
  }
  return all;
}

void expect_full_redraw(const SceneView& scene, const std::string& what) {
  const OffscreenContext context;
  SceneRenderer kept;
  int number = 0;
  for (const SceneView& view : course(scene)) {
    kept.draw(view, kWidth, kHeight);
    EXPECT_EQ(kept.made(PictureCache::kVolume), number == 0) << what << " " << number;
    SceneView in_full = view;
    in_full.volume->cache_picture = false;
    SceneRenderer fresh;
    fresh.draw(in_full, kWidth, kHeight);
    const Image image = kept.read();
    ASSERT_LE(worst_difference(image, fresh.read()), 1) << what << " " << number;
    ++number;
  }
}

TEST(CachedVolume, GivesThePictureOfAFullRedraw) {
  using Change = std::function<void(SceneView&)>;
  Lens ball{make_sphere({0.1, -0.1, 0.1}, 0.5)};
  ball.transfer = ColorTransfer({{0.3, {0.2F, 1.0F, 0.4F}, 0.0}, {0.8, {1.0F, 1.0F, 0.2F}, 0.2}});
  const std::vector<std::pair<const char*, Change>> changes{
      {"lit", [](SceneView&) {}},
      {"unlit", [](SceneView& v) { v.volume->shading = false; }},
      {"a lens", [&](SceneView& v) { v.volume->lenses = {ball}; }},
      {"a lens that enlarges",
       [&](SceneView& v) {
         v.volume->lenses = {ball};
         v.volume->lenses[0].magnification = 2.0;
       }},
      {"a cut with its image",
       [](SceneView& v) {
         v.volume->cuts = {{.kept = {glm::normalize(Vec3(0.3, -1.0, 0.2)), 0.1}}};
         v.volume->planes.shown = true;
       }},
      {"bricks", [](SceneView& v) { v.volume->storage.brick_cells = 8; }},
      {"opaque, all rays ended early", [](SceneView& v) { v.volume->opacity_length = 1e-4; }}};
  for (const auto& [what, change] : changes) {
    SceneView view = scene_of(Projection::kPerspective);
    change(view);
    expect_full_redraw(view, what);
  }
  expect_full_redraw(scene_of(Projection::kOrthographic), "orthographic");
}

// What changes the volume or the view is seen at once.
TEST(CachedVolume, IsOfTheVolumeAndTheViewThatAreShown) {
  const OffscreenContext context;
  SceneRenderer kept;
  SceneView view = scene_of(Projection::kPerspective);
  const auto draws_anew = [&](const char* what) {
    kept.draw(view, kWidth, kHeight);
    EXPECT_TRUE(kept.made(PictureCache::kVolume)) << what;
    SceneRenderer fresh;
    fresh.draw(view, kWidth, kHeight);
    EXPECT_LE(worst_difference(kept.read(), fresh.read()), 1) << what;
    kept.draw(view, kWidth, kHeight);
    EXPECT_FALSE(kept.made(PictureCache::kVolume)) << what;
  };
  draws_anew("first");
  turn(view.camera, 0.2, 0.1);
  draws_anew("turned");
  view.volume->samples_per_voxel = 2.0;
  draws_anew("coarser");
  view.volume->cuts = {{.kept = {{1.0, 0.0, 0.0}, 0.3}}};
  draws_anew("cut");
  kept.forget(PictureCache::kVolume);
  draws_anew("forgotten");
  // A smaller picture around lenses is told apart by what is opaque about it: it is drawn every time.
  view.volume->lenses = {Lens{make_sphere(Vec3(0.0), 0.4)}};
  view.volume->context.viewport = 0.5;
  kept.draw(view, kWidth, kHeight);
  EXPECT_FALSE(kept.made(PictureCache::kVolume));
}

/// A white fog that begins at y = 0 and hides all behind it, seen along +y, with a ball at `y`.
SceneView fog_and_ball(double y, double see_through) {
  SceneView view = front_view({});
  view.volume = sampled_view([](const Vec3& x) { return x.y; });
  view.volume->transfer = ColorTransfer({{-0.01, {1.0F, 1.0F, 1.0F}, 0.0}, {0.01, {1.0F, 1.0F, 1.0F}, 1.0}});
  view.volume->shading = false;
  view.probe = ProbeView{.probe = {0.0, y, 0.0}};
  view.probe->style.probe_size = 200.0;
  view.probe->style.see_through = see_through;
  return view;
}

TEST(ProbeInAVolume, IsVeiledByWhatLiesBeforeItAndShinesThrough) {
  const auto middle = [](double y, double see_through) {
    return at(render_image(fog_and_ball(y, see_through), kSize, kSize).image, 0.0, 0.0);
  };
  const auto before = middle(-0.6, 0.0), behind = middle(0.6, 0.0), half = middle(0.6, 0.5);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(behind[c], 255) << "nothing of it is seen";
    EXPECT_EQ(middle(-0.6, 0.5)[c], before[c]) << "nothing is before it";
    EXPECT_NEAR(half[c], 0.5 * (before[c] + 255), 1.5);
  }
  EXPECT_LT(before[0], 250);
}

}  // namespace
}  // namespace palpate::test
