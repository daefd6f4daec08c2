// Panes of slices: which side of a patient is where, one scale for all, lines of the other planes through the crosshair,
// outlines of lenses and cuts in each plane.

#include "common/render/slice/slice_panes.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/render/lens/lens.h"
#include "tests/support/panes_about.h"

namespace palpate {
namespace {

constexpr Vec3 kRight{1.0, 0.0, 0.0}, kFront{0.0, 1.0, 0.0}, kHead{0.0, 0.0, 1.0};

SceneView scene_of(const Index3& points, const Vec3& spacing) {
  auto image = std::make_shared<VolumeImage>();
  image->points = points;
  image->origin = {-10.0, 5.0, 30.0};
  image->axes = Mat3{spacing.x, 0.0, 0.0, 0.0, spacing.y, 0.0, 0.0, 0.0, spacing.z};
  auto numbers = std::make_shared<std::vector<float>>(image->point_count(), 1.0F);
  image->bytes = std::as_bytes(std::span<const float>(*numbers));
  image->owner = numbers;
  image->lowest = 0.0;
  image->highest = 2.0;
  SceneView scene;
  scene.bounds = image->bounds();
  scene.anatomical = true;
  scene.volume.emplace().image = image;
  scene.volume->panes = test::panes_about(scene.bounds);
  scene.volume->panes.layout = 4;
  return scene;
}

Camera camera_of(const SceneView& scene, SlicePlane plane) {
  const SlicePanes& panes = scene.volume->panes;
  const std::vector<Pane> parts = panes_of(panes, 800, 600);
  const auto pane =
      std::find_if(parts.begin(), parts.end(), [&](const Pane& one) { return one.plane == plane; });
  return pane_view(scene, panes, parts, *pane).camera;
}

void expect_axes(const Camera& camera, const Vec3& right, const Vec3& up) {
  EXPECT_LT(glm::distance(camera.axes[0], right), 1e-15);
  EXPECT_LT(glm::distance(camera.axes[1], up), 1e-15);
  EXPECT_LT(glm::distance(camera.axes[2], glm::cross(right, up)), 1e-15)
      << "right-handed: nothing is mirrored";
}

TEST(SlicePanes, APatientIsSeenAsRadiologistsDo) {
  SceneView scene = scene_of({40, 50, 30}, {1.0, 1.0, 2.0});
  expect_axes(camera_of(scene, SlicePlane::kAxial), -kRight, kFront);
  expect_axes(camera_of(scene, SlicePlane::kCoronal), -kRight, kHead);
  expect_axes(camera_of(scene, SlicePlane::kSagittal), kFront, kHead);
  scene.volume->panes.radiological = false;
  expect_axes(camera_of(scene, SlicePlane::kAxial), kRight, kFront);
  expect_axes(camera_of(scene, SlicePlane::kCoronal), kRight, kHead);
  expect_axes(camera_of(scene, SlicePlane::kSagittal), kFront, kHead);
  // Other data have no left and right to be turned.
  scene.volume->panes.radiological = true;
  scene.anatomical = false;
  expect_axes(camera_of(scene, SlicePlane::kAxial), kRight, kFront);
}

TEST(SlicePanes, FillThePictureWithoutOverlap) {
  SlicePanes panes;
  for (const int layout : {1, 2, 4}) {
    panes.layout = layout;
    const std::vector<Pane> parts = panes_of(panes, 641, 483);
    EXPECT_EQ(parts.size(), static_cast<std::size_t>(layout));
    EXPECT_EQ(std::count_if(parts.begin(), parts.end(), [](const Pane& pane) { return !pane.plane; }), 1);
    for (int y = 0; y < 483; y += 7) {
      for (int x = 0; x < 641; x += 7) {
        const auto at =
            std::count_if(parts.begin(), parts.end(), [&](const Pane& pane) { return pane.contains(x, y); });
        EXPECT_LE(at, 1);
        const bool gap = std::abs(x - 320) <= 1 || std::abs(y - 241) <= 1;
        if (!gap) {
          EXPECT_EQ(at, 1) << x << " " << y;
        }
      }
    }
  }
}

/// All of the volume is seen, and a millimetre is as long in each pane.
TEST(SlicePanes, HaveOneScaleAtWhichAllIsSeen) {
  for (const Index3 points : {Index3{40, 50, 30}, Index3{400, 20, 20}, Index3{5, 5, 300}}) {
    const SceneView scene = scene_of(points, {1.0, 1.5, 2.0});
    const SlicePanes& panes = scene.volume->panes;
    const std::vector<Pane> parts = panes_of(panes, 900, 500);
    double scale = 0.0;
    for (const Pane& pane : parts) {
      if (!pane.plane) continue;
      const Camera camera = pane_view(scene, panes, parts, pane).camera;
      const double pixel = camera.view_height / pane.height;
      if (scale > 0.0) {
        EXPECT_NEAR(pixel, scale, 1e-12 * scale);
      }
      scale = pixel;
      for (unsigned corner = 0; corner < 8; ++corner) {
        const Vec3 x = glm::mix(scene.bounds.lower, scene.bounds.upper,
                                Vec3(corner & 1U, corner >> 1U & 1U, corner >> 2U));
        const Vec3 at = project(camera, x, pane.width, pane.height);
        EXPECT_GE(std::min(at.x, at.y), 0.0);
        EXPECT_LE(at.x, pane.width);
        EXPECT_LE(at.y, pane.height);
      }
    }
  }
}

/// A place under a pixel is drawn there, and lies in the plane, however the planes are turned.
TEST(SlicePanes, PlacesUnderPixelsAreDrawnThere) {
  std::mt19937 random{3};
  std::normal_distribution<double> normal;
  SceneView scene = scene_of({40, 50, 30}, {1.0, 1.0, 2.0});
  SlicePanes& panes = scene.volume->panes;
  for (int run = 0; run < 100; ++run) {
    panes.turn = glm::normalize(Quat(normal(random), normal(random), normal(random), normal(random)));
    panes.cross = scene.bounds.center() + 5.0 * Vec3(normal(random), normal(random), normal(random));
    panes.zoom = std::exp(normal(random));
    panes.radiological = run % 2 == 0;
    const std::vector<Pane> parts = panes_of(panes, 700, 500);
    for (const Pane& pane : parts) {
      if (!pane.plane) continue;
      const SceneView view = pane_view(scene, panes, parts, pane);
      const Vec3 normal_here = normal_of(panes, *pane.plane);
      EXPECT_NEAR(std::abs(glm::dot(view.camera.axes[2], normal_here)), 1.0, 1e-12);
      EXPECT_NEAR(glm::determinant(view.camera.axes), 1.0, 1e-12);
      const Vec3 x = place_under(view.camera, pane, pane.left + 20.25, pane.top + 31.5);
      EXPECT_NEAR(glm::dot(x - panes.cross, normal_here), 0.0, 1e-9);
      const Vec3 at = project(view.camera, x, pane.width, pane.height);
      EXPECT_NEAR(at.x, 20.25, 1e-6);
      EXPECT_NEAR(at.y, 31.5, 1e-6);
      // The other planes' lines lie in both planes, and go through the crosshair.
      ASSERT_GE(view.slice->traces.size(), 2U);
      for (std::size_t i = 0; i < 2; ++i) {
        const std::vector<Vec3>& line = view.slice->traces[i].points;
        const Vec3 along = glm::normalize(line.back() - line.front());
        EXPECT_NEAR(glm::dot(along, normal_here), 0.0, 1e-12);
        EXPECT_NEAR(glm::length(glm::cross(panes.cross - line.front(), along)), 0.0, 1e-9);
      }
    }
  }
}

/// A ball's outline is the circle in which the plane cuts it; where that misses it there is none.
TEST(SlicePanes, LensesHaveTheirOutlines) {
  SceneView scene = scene_of({81, 81, 81}, {1.0, 1.0, 1.0});
  const Vec3 middle = scene.bounds.center();
  constexpr double kRadius = 12.0;
  scene.volume->lenses.push_back({.shape = make_sphere(middle, kRadius)});
  SlicePanes& panes = scene.volume->panes;
  for (const double off : {0.0, 5.0, -11.9, 12.1}) {
    panes.cross = middle + Vec3(0.0, 0.0, off);
    const std::vector<Pane> parts = panes_of(panes, 800, 600);
    const SceneView view = pane_view(scene, panes, parts, parts.front());
    ASSERT_EQ(*parts.front().plane, SlicePlane::kAxial);
    ASSERT_EQ(view.slice->traces.size(), std::abs(off) < kRadius ? 3U : 2U) << off;
    if (std::abs(off) >= kRadius) continue;
    const double radius = std::sqrt(kRadius * kRadius - off * off);
    double left = HUGE_VAL, right = -HUGE_VAL;
    for (const Vec3& x : view.slice->traces.back().points) {
      EXPECT_NEAR(glm::distance(x, panes.cross), radius, 1e-6 * kRadius) << off;
      EXPECT_NEAR(x.z, panes.cross.z, 1e-12);
      left = std::min(left, x.x);
      right = std::max(right, x.x);
    }
    EXPECT_NEAR(right - left, 2.0 * radius, 0.01 * radius);
    EXPECT_EQ(view.slice->traces.back().points.front(), view.slice->traces.back().points.back()) << "closed";
  }
}

/// What is marked is seen in the slices that it reaches, and in no others.
TEST(SlicePanes, NotesAreSeenWhereTheyLie) {
  SceneView scene = scene_of({81, 81, 81}, {1.0, 1.0, 1.0});
  const Vec3 middle = scene.bounds.center();
  scene.notes.push_back({.points = {middle + Vec3(0.0, 0.0, -3.0), middle + Vec3(0.0, 0.0, 4.0)}});
  SlicePanes& panes = scene.volume->panes;
  const auto seen = [&](SlicePlane plane, double off) {
    panes.cross = middle;
    panes.cross[static_cast<int>(plane)] += off;
    const std::vector<Pane> parts = panes_of(panes, 800, 600);
    const auto pane =
        std::find_if(parts.begin(), parts.end(), [&](const Pane& one) { return one.plane == plane; });
    return !pane_view(scene, panes, parts, *pane).notes.empty();
  };
  EXPECT_TRUE(seen(SlicePlane::kAxial, 0.0));
  EXPECT_TRUE(seen(SlicePlane::kAxial, 4.4));
  EXPECT_FALSE(seen(SlicePlane::kAxial, 4.6));
  EXPECT_FALSE(seen(SlicePlane::kAxial, -3.6));
  EXPECT_TRUE(seen(SlicePlane::kSagittal, 0.4));
  EXPECT_FALSE(seen(SlicePlane::kSagittal, 0.6));
  panes.slab = 10.0;
  EXPECT_TRUE(seen(SlicePlane::kAxial, 8.9));
  EXPECT_FALSE(seen(SlicePlane::kAxial, 9.1));
}

TEST(SlicePanes, ShowTractsInASlabAndTheProbeWhole) {
  SceneView scene = scene_of({40, 50, 30}, {1.0, 1.0, 2.0});
  auto lines = std::make_shared<Tractogram>();
  lines->points = {{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}};
  lines->starts = {0, 2};
  scene.tracts = TractView{.bundle = make_tract_bundle(lines)};
  scene.probe.emplace().probe = {1.0, 2.0, 3.0};
  const SlicePanes& panes = scene.volume->panes;
  const std::vector<Pane> parts = panes_of(panes, 800, 600);
  const SceneView axial = pane_view(scene, panes, parts, parts.front());
  ASSERT_TRUE(axial.tracts && axial.tracts->slab);
  EXPECT_EQ(axial.tracts->slab->half, 2.0) << "two steps of 2 thick";
  EXPECT_EQ(std::abs(axial.tracts->slab->normal.z), 1.0);
  EXPECT_EQ(axial.tracts->slab->place.z, panes.cross.z);
  EXPECT_FALSE(axial.tracts->depth_cue);
  ASSERT_TRUE(axial.probe);
  EXPECT_EQ(axial.probe->probe, scene.probe->probe);
  EXPECT_FALSE(scene.tracts->slab) << "all of them in the scene itself";
  scene.tracts->slab_thickness = 7.0;
  EXPECT_EQ(pane_view(scene, panes, parts, parts.front()).tracts->slab->half, 3.5);
}

TEST(SlicePanes, ShowTheImageThatIsChosenWithItsWindow) {
  SceneView scene = scene_of({4, 5, 3}, {1.0, 1.0, 2.0});
  const SceneView other = scene_of({4, 5, 3}, {1.0, 1.0, 2.0});
  scene.volume->slice_images = {
      {.name = "md", .image = other.volume->image, .window = {.width = 3.0, .level = 1.5}, .colored = true}};
  scene.volume->panes.shown = "md";
  const auto slice = [&] {
    const std::vector<Pane> parts = panes_of(scene.volume->panes, 800, 600);
    return *pane_view(scene, scene.volume->panes, parts, parts.front()).slice;
  };
  EXPECT_EQ(slice().image, other.volume->image);
  EXPECT_EQ(slice().window, (ValueWindow{.width = 3.0, .level = 1.5}));
  EXPECT_TRUE(slice().colored);
  scene.volume->panes.window = ValueWindow{.width = 1.0, .level = 0.0};
  EXPECT_EQ(slice().window, (ValueWindow{.width = 1.0, .level = 0.0}));
  scene.volume->panes.shown = "b0";
  EXPECT_EQ(slice().image, scene.volume->image) << "of what is not there the volume's own values";
}

TEST(SlicePanes, OutlineRegionsInTheirColours) {
  SceneView scene = scene_of({40, 50, 30}, {1.0, 1.0, 2.0});
  const Rgb green{0.0F, 1.0F, 0.0F};
  scene.regions = {{.shapes = {make_sphere(scene.bounds.center(), 5.0)}, .color = green}};
  const std::vector<Pane> parts = panes_of(scene.volume->panes, 800, 600);
  const SceneView axial = pane_view(scene, scene.volume->panes, parts, parts.front());
  EXPECT_EQ(std::ranges::count_if(axial.slice->traces,
                                  [&](const SliceTrace& trace) { return trace.color == green; }),
            1);
}

}  // namespace
}  // namespace palpate
