// Transparent lines in a volume: what lies before them veils them, they veil what lies behind, at their
// depth.
//
// The picture of flat ribbons is known from the brute-force integrator: a ribbon that lies in the plane n.x =
// d has the volume cut at that plane before and behind it,
//   C = C[front] + (1 - A[front]) (a c + (1 - a) (C[back] + (1 - A[back]) background))            (1)
// and so on for several of them. Its colour c is that of the opaque ribbon without a volume.

#include <algorithm>
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
#include "tests/common/render/sample_scenes.h"
#include "tests/common/render/volume/sample_volumes.h"
#include "tests/support/reference_ray.h"

namespace palpate::test {
namespace {

constexpr int kPixels = 64;
constexpr double kSamples = 16.0;       // a voxel, of reference rays
constexpr double kOpacity = 0.6;        // of lines
constexpr double kBound = 2.0 / 255.0;  // of a channel

/// A straight line, and the plane in which its ribbon lies.
struct Ribbon {
  Vec3 from, to;
  ConvexShape::HalfSpace before;  ///< what lies nearer to the viewer
};

/// Along the viewing direction of an orthographic camera or before the middle of a perspective one, where
/// ribbons are flat.
Ribbon ribbon(const Vec3& from, const Vec3& to, const Camera& camera) {
  const Vec3 tangent = glm::normalize(to - from);
  Vec3 normal = glm::cross(tangent, glm::cross(tangent, camera.axes[2]));
  normal = glm::normalize(glm::dot(normal, camera.axes[2]) > 0.0 ? -normal : normal);  // away from the eye
  return {from, to, {normal, glm::dot(normal, from)}};
}

/// Blobs with a matter that is nowhere opaque, without outline, axes or bar.
SceneView scene_of(const Camera& camera, const std::vector<Ribbon>& ribbons) {
  SceneView view;
  view.volume = sampled_view(blobs);
  view.volume->transfer = ColorTransfer({{0.4, {0.9F, 0.5F, 0.2F}, 0.0}, {0.7, {0.3F, 0.6F, 1.0F}, 0.1}});
  view.volume->opacity_length = 0.05;
  view.bounds = view.volume->image->bounds();
  view.camera = camera;
  view.show_outline = view.show_axes = view.show_color_bar = false;
  view.style.depth_cue = false;
  view.style.halo = false;
  view.style.width = 160.0;
  view.style.opacity = kOpacity;
  view.style.range = ValueRange{0.0, 1.0};
  std::vector<Line> lines;
  for (std::size_t i = 0; i < ribbons.size(); ++i)
    lines.push_back(polyline({ribbons[i].from, ribbons[i].to}, 0.2 + 0.3 * static_cast<double>(i)));
  view.lines = std::make_shared<const std::vector<Line>>(std::move(lines));
  return view;
}

Camera camera_of(const CameraAngles& angles, Projection projection) {
  return make_camera({Vec3(-1.0), Vec3(1.0)}, angles, 1.0, projection);
}

/// Whether all of a pixel shows the ribbon, -1 where none does, else 0: at its edge.
int place_of(const Image& shown, const Image& without, int x, int y) {
  const auto differs = [&](int i, int j) {
    const int column = std::clamp(i, 0, kPixels - 1), row = std::clamp(j, 0, kPixels - 1);
    return shown.pixel(column, row) != without.pixel(column, row);
  };
  int count = 0;
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 1; ++j) count += differs(x + i, y + j) ? 1 : 0;
  }
  return count == 9 ? 1 : count == 0 ? -1 : 0;
}

struct Found {
  double worst = 0.0;  ///< of a channel
  int veiled = 0;      ///< pixels with a line that were compared
  int exempt = 0;      ///< whose reference is no surer than that
};

class LayeredLines : public testing::Test {
 protected:
  Image picture_of(const SceneView& view) {
    renderer_.draw(view, kPixels, kPixels);
    return renderer_.read();
  }
  void expect_reference(const SceneView& view, const std::vector<Ribbon>& ribbons, const std::string& what);

 private:
  Found compare_with_reference(const SceneView& view, const std::vector<Ribbon>& ribbons);

  OffscreenContext context_;
  SceneRenderer renderer_;  // of one picture after the other, as in a window
};

/// Compares with (1). @param ribbons from front to back.
Found LayeredLines::compare_with_reference(const SceneView& view, const std::vector<Ribbon>& ribbons) {
  const Image shown = picture_of(view);
  // Each ribbon alone, opaque, and what is behind all of them.
  std::vector<Image> alone;
  SceneView bare = view;
  bare.volume.reset();
  bare.style.opacity = 1.0;
  for (const Line& line : *view.lines) {
    bare.lines = std::make_shared<const std::vector<Line>>(std::vector<Line>{line});
    alone.push_back(picture_of(bare));
  }
  bare.lines.reset();
  const Image nothing = picture_of(bare);

  // What lies between two ribbons.
  std::vector<VolumeView> between(ribbons.size() + 1, *view.volume);
  for (std::size_t i = 0; i < between.size(); ++i) {
    if (i < ribbons.size()) between[i].cuts.push_back({.kept = ribbons[i].before});
    if (i > 0)
      between[i].cuts.push_back({.kept = {-ribbons[i - 1].before.outward, -ribbons[i - 1].before.offset}});
  }
  std::vector<ReferenceRay> rays;
  for (const VolumeView& part : between) rays.emplace_back(part, view.camera, kPixels, kPixels, kSamples);
  const ReferenceRay whole(*view.volume, view.camera, kPixels, kPixels, kSamples);

  Found found;
  for (int y = 0; y < kPixels; ++y) {
    for (int x = 0; x < kPixels; ++x) {
      std::vector<std::size_t> here;
      bool edge = false;
      for (std::size_t i = 0; i < alone.size(); ++i) {
        const int place = place_of(alone[i], nothing, x, y);
        edge = edge || place == 0;
        if (place > 0) here.push_back(i);
      }
      if (edge) continue;
      const auto expected = [&](double dx, double dy) {
        const double px = x + 0.5 + dx, py = kPixels - y - 0.5 + dy;
        Rgba sum{};
        const auto add = [&](const Rgba& seen) {
          const double light = 1.0 - sum[3];
          for (std::size_t c = 0; c < 4; ++c) sum[c] += light * seen[c];
        };
        for (std::size_t i = 0; i <= ribbons.size(); ++i) {
          add(rays[i].cast(px, py));
          if (std::find(here.begin(), here.end(), i) == here.end()) continue;
          const auto color = alone[i].pixel(x, y);
          Rgba layer{0.0, 0.0, 0.0, kOpacity};
          for (std::size_t c = 0; c < 3; ++c) layer[c] = kOpacity * color[c] / 255.0;
          add(layer);
        }
        const auto back = nothing.pixel(x, y);
        add({back[0] / 255.0, back[1] / 255.0, back[2] / 255.0, 1.0});
        return sum;
      };
      const Rgba here_expected = expected(0.0, 0.0);
      const auto off = [&](const auto& other) {
        double most = 0.0;
        for (std::size_t c = 0; c < 3; ++c) most = std::max(most, std::abs(here_expected[c] - other(c)));
        return most;
      };
      const auto seen = shown.pixel(x, y);
      const double here_off = off([&](std::size_t c) { return seen[c] / 255.0; });
      constexpr double kShift = 1e-3;
      bool unsure = false;
      for (const auto& [dx, dy] : {std::pair{kShift, 0.0}, {-kShift, 0.0}, {0.0, kShift}, {0.0, -kShift}}) {
        if (!(here_off > kBound) || unsure) break;
        const Rgba beside = expected(dx, dy);
        unsure = off([&](std::size_t c) { return beside[c]; }) > kBound;
      }
      if (unsure) {
        ++found.exempt;
        continue;
      }
      found.worst = std::max(found.worst, here_off);
      found.veiled += here.empty() ? 0 : 1;
    }
  }
  return found;
}

void LayeredLines::expect_reference(const SceneView& view, const std::vector<Ribbon>& ribbons,
                                    const std::string& what) {
  const Found found = compare_with_reference(view, ribbons);
  EXPECT_LE(found.worst, kBound) << what;
  EXPECT_LE(found.exempt, kPixels * kPixels / 500) << what;
  EXPECT_GT(found.veiled, 150) << what << ": the line is seen";
}

TEST_F(LayeredLines, AgreeWithTheReferenceBeforeInAndBehindMatter) {
  for (const Projection projection : {Projection::kOrthographic, Projection::kPerspective}) {
    const Camera camera = camera_of({.azimuth = 0.0, .elevation = 0.0}, projection);
    for (const double y : {-1.4, -0.3, 0.45, 1.4}) {
      const std::vector<Ribbon> one{ribbon({-0.9, y, 0.0}, {0.9, y, 0.0}, camera)};
      expect_reference(scene_of(camera, one), one, "y = " + std::to_string(y));
    }
  }
}

TEST_F(LayeredLines, AgreeWithTheReferenceWhereTheyRunThroughMatter) {
  const Camera camera = camera_of({.azimuth = 30.0, .elevation = 20.0}, Projection::kOrthographic);
  const std::vector<Ribbon> one{ribbon({-0.9, -0.8, 0.3}, {0.8, 0.9, -0.2}, camera)};
  using Change = std::function<void(VolumeView&)>;
  Lens ball{make_sphere({0.1, -0.1, 0.1}, 0.5)};
  ball.transfer = ColorTransfer({{0.3, {0.2F, 1.0F, 0.4F}, 0.0}, {0.8, {1.0F, 1.0F, 0.2F}, 0.2}});
  const std::vector<std::pair<const char*, Change>> changes{
      {"unlit", [](VolumeView&) {}},
      {"lit", [](VolumeView& v) { v.shading = true; }},
      {"a lens", [&](VolumeView& v) { v.lenses = {ball}; }},
      {"a lens that enlarges",
       [&](VolumeView& v) {
         v.lenses = {ball};
         v.lenses[0].magnification = 1.5;
       }},
      {"a lens that cuts",
       [&](VolumeView& v) {
         v.lenses = {ball};
         v.lenses[0].cut = true;
       }},
      {"a cut",
       [](VolumeView& v) {
         v.cuts = {{.kept = {glm::normalize(Vec3(0.3, -1.0, 0.2)), 0.2}}};
       }},
      {"bricks, no tiles", [](VolumeView& v) {
         v.storage.brick_cells = 8;
         v.skip_empty = false;
       }}};
  for (const auto& [what, change] : changes) {
    SceneView view = scene_of(camera, one);
    change(*view.volume);
    expect_reference(view, one, what);
  }
  // Regions of value and gradient.
  SceneView view = scene_of(camera, one);
  view.volume->regions = RegionTransfer({{.corners = {Vec2(0.4, 0.0), Vec2(0.9, 4.0), Vec2(0.0)}}});
  expect_reference(view, one, "regions");
}

TEST_F(LayeredLines, AgreeWithTheReferenceWhereSeveralLieBehindEachOther) {
  const Camera camera = camera_of({.azimuth = 0.0, .elevation = 0.0}, Projection::kOrthographic);
  // Given out of order, crossing each other's pixels at depths of their own.
  const std::vector<Ribbon> front_to_back{ribbon({-0.9, -0.6, 0.0}, {0.9, -0.6, 0.0}, camera),
                                          ribbon({0.0, -0.2, -0.9}, {0.0, -0.2, 0.9}, camera),
                                          ribbon({-0.7, 0.2, -0.6}, {0.7, 0.2, 0.6}, camera),
                                          ribbon({-0.7, 0.7, 0.6}, {0.7, 0.7, -0.6}, camera)};
  SceneView view = scene_of(camera, front_to_back);
  expect_reference(view, front_to_back, "sorted");
  const Image sorted = picture_of(view);
  std::vector<Line> mixed = *view.lines;
  std::swap(mixed[0], mixed[2]);
  std::swap(mixed[1], mixed[3]);
  view.lines = std::make_shared<const std::vector<Line>>(mixed);
  EXPECT_EQ(picture_of(view).rgba, sorted.rgba) << "in whichever order they come";
}

// Hundreds in one pixel are all shown: n layers of opacity a let (1 - a)^n through.
TEST_F(LayeredLines, HaveNoLargestNumber) {
  const Camera camera = camera_of({.azimuth = 0.0, .elevation = 0.0}, Projection::kOrthographic);
  constexpr int kLines = 300;
  constexpr double kFaint = 0.004;
  SceneView view = scene_of(camera, {});
  view.volume->transfer = ColorTransfer({{0.0, {0.0F, 0.0F, 0.0F}, 0.0}});
  view.style.color_by = ColorBy::kUniform;
  view.style.opacity = kFaint;
  std::vector<Line> lines;
  for (int i = 0; i < kLines; ++i) {
    const double y = -0.9 + 1.8 * ((i * 7) % kLines) / kLines;
    lines.push_back(polyline({{-0.9, y, 0.0}, {0.9, y, 0.0}}));
  }
  view.lines = std::make_shared<const std::vector<Line>>(lines);
  const int middle = kPixels / 2;
  const auto seen = picture_of(view).pixel(middle, middle);
  view.style.opacity = 1.0;
  const auto color = picture_of(view).pixel(middle, middle);
  view.lines.reset();
  const auto back = picture_of(view).pixel(middle, middle);
  const double through = std::pow(1.0 - kFaint, kLines);
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(seen[c], color[c] + through * (back[c] - color[c]), 1.5) << "of all " << kLines;
}

// Lines that are hardly transparent look like opaque ones, edges and joints included; clearing is a share of
// the opacity, by the value.
TEST_F(LayeredLines, GoOverIntoOpaqueOnes) {
  SceneView view = whirlwind(1.0, 12);
  VolumeView volume = sampled_view(blobs);
  volume.transfer = ColorTransfer({{0.4, {0.9F, 0.5F, 0.2F}, 0.0}, {0.7, {0.3F, 0.6F, 1.0F}, 0.05}});
  volume.opacity_length = 0.05;
  view.volume = volume;
  view.bounds = volume.image->bounds();
  view.style.halo = false;
  view.style.width = 30.0;
  const Image opaque = picture_of(view);
  view.style.opacity = 0.99999;
  const Image layered = picture_of(view);
  // A ray ends at one depth in each pixel, an opaque line at one in each sample: at edges they differ.
  EXPECT_LT(mean_difference(opaque, layered), 0.6);
  int different = 0;
  for (std::size_t i = 0; i < opaque.rgba.size(); ++i)
    different += std::abs(opaque.rgba[i] - layered.rgba[i]) > 40 ? 1 : 0;
  EXPECT_LT(different, static_cast<int>(opaque.rgba.size() / 200));

  view.style.opacity = 0.5;
  const Image half = picture_of(view);
  view.style.opacity = 1.0;
  view.style.clearing = 1.0;
  view.style.range = ValueRange{-1e6, 1e6};  // all in the middle of the colour map
  const Image cleared = picture_of(view);
  view.style.clearing = 0.0;
  view.style.opacity = 0.5;
  EXPECT_LE(worst_difference(cleared, picture_of(view)), 1);
  EXPECT_GT(mean_difference(half, opaque), 0.3);
}

// Opaque things in front hide them, those behind are seen through them; in a kept picture, too, while the
// opaque things move, and with other lines or another style at once.
TEST_F(LayeredLines, StandAmongOpaqueThingsAndInKeptPictures) {
  const Camera camera = camera_of({.azimuth = 25.0, .elevation = 15.0}, Projection::kPerspective);
  SceneView view = scene_of(camera, {ribbon({-0.9, -0.3, 0.2}, {0.9, 0.4, 0.1}, camera)});
  view.probe = ProbeView{.probe = {0.5, -0.8, 0.1}, .proxy = {0.2, 0.6, 0.0}};
  view.probe->style.probe_size = view.probe->style.proxy_size = 150.0;
  view.volume->cache_picture = true;
  SceneRenderer kept;
  const auto expect_full = [&](const char* what, bool anew) {
    kept.draw(view, kPixels, kPixels);
    EXPECT_EQ(kept.made(PictureCache::kVolume), anew) << what;
    SceneView in_full = view;
    in_full.volume->cache_picture = false;
    SceneRenderer fresh;
    fresh.draw(in_full, kPixels, kPixels);
    EXPECT_LE(worst_difference(kept.read(), fresh.read()), 1) << what;
    return kept.read();
  };
  const Image first = expect_full("first", true);
  view.probe->probe += Vec3(-0.5, 0.0, 0.1);
  view.probe->proxy += Vec3(-0.4, 0.0, 0.2);
  const Image moved = expect_full("moved", false);
  EXPECT_GT(mean_difference(first, moved), 1.0);
  view.style.opacity = 0.2;
  const Image fainter = expect_full("fainter", true);
  EXPECT_GT(mean_difference(fainter, moved), 0.3);
  view.lines =
      std::make_shared<const std::vector<Line>>(std::vector{polyline({{-0.5, 0.0, -0.5}, Vec3(0.5)}, 0.5)});
  (void)expect_full("another line", true);
  view.style.opacity = 1.0;
  (void)expect_full("opaque", true);
  view.style.opacity = 0.4;
  view.volume->shown = false;
  kept.draw(view, kPixels, kPixels);
  const Image hidden = kept.read();
  view.volume.reset();
  EXPECT_EQ(picture_of(view).rgba, hidden.rgba) << "as without a volume";
}

// What is saved on the context of lenses is not, and the error of the picture is that of its rays.
TEST_F(LayeredLines, AreDividedFromNeitherContextNorErrorEstimate) {
  const Camera camera = camera_of({.azimuth = 30.0, .elevation = 20.0}, Projection::kOrthographic);
  SceneView view = scene_of(camera, {ribbon({-0.9, -0.8, 0.3}, {0.8, 0.9, -0.2}, camera)});
  view.volume->lenses = {Lens{make_sphere({0.1, -0.1, 0.1}, 0.5)}};
  const Image whole = picture_of(view);
  view.volume->context = {.viewport = 0.5, .level = 1};
  EXPECT_EQ(picture_of(view).rgba, whole.rgba);
  const RenderedImage estimated = render_image(view, kPixels, kPixels, 0, 0.0, true);
  ASSERT_TRUE(estimated.error.has_value());
  EXPECT_LE(estimated.error->worst, kBound);
}

}  // namespace
}  // namespace palpate::test
