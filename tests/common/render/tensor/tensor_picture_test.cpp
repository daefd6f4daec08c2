// Pictures of slices and glyphs: pixels that are known, and pictures kept beside the tests, looked at by
// people.

#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "common/render/gl/context.h"
#include "common/render/scene_renderer.h"
#include "tests/common/render/picture_checks.h"
#include "tests/common/render/tensor/sample_tensors.h"

namespace palpate::test {
namespace {

/// Voxels of 0.1 about the origin.
std::shared_ptr<const TensorVoxels> helix_image(const Mat3& turn = Mat3(1.0)) {
  return sampled_tensors(centred_lattice({21, 21, 21}, turn * Mat3(0.1)), helix_tensor);
}

SceneView tensor_scene(std::shared_ptr<const TensorVoxels> image, const CameraAngles& angles = {}) {
  SceneView view;
  view.bounds = image->bounds();
  view.camera = make_camera(view.bounds, angles, 4.0 / 3.0);
  view.show_axes = view.show_color_bar = false;
  view.tensors = TensorView{.image = std::move(image)};
  return view;
}

/// Looked at along +y: x to the right, z up.
SceneView front_slice(const TensorView& tensors) {
  SceneView view = front_view({});
  view.tensors = tensors;
  view.tensors->slices = {false, true, false};
  view.tensors->crosshair = false;
  return view;
}

TEST(SlicePicture, ShowsEachVoxelInItsColour) {
  // Left half across, right half up; the upper edge has no tensors.
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const auto image = sampled_tensors(centred_lattice({10, 10, 10}, Mat3(0.2)), [&](const Vec3& x) {
    if (x.z > 0.6) return Mat3(nothing);
    return linear_tensor(x.x < 0.0 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 0.0, 1.0), 1.0, 0.0);
  });
  SceneView view = front_slice({.image = image});
  const Image picture = render_image(view, kSize, kSize).image;
  const auto left = at(picture, -0.5, 0.1), right = at(picture, 0.5, 0.1), above = at(picture, 0.3, 0.9);
  EXPECT_EQ(left[0], 255);
  EXPECT_EQ(left[1], 0);
  EXPECT_EQ(left[2], 0);
  EXPECT_EQ(right[0], 0);
  EXPECT_EQ(right[2], 255);
  EXPECT_TRUE(is_background(above));

  view.tensors->color = TensorColor::kFa;
  const Image grey = render_image(view, kSize, kSize).image;
  for (const std::size_t c : {0U, 1U, 2U}) EXPECT_EQ(at(grey, -0.5, 0.1)[c], 255);
}

TEST(SlicePicture, VoxelsHaveEdgesUnlessSmooth) {
  const auto image = sampled_tensors(centred_lattice({10, 10, 10}, Mat3(0.2)), [&](const Vec3& x) {
    return linear_tensor(x.x < 0.0 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 0.0, 1.0), 1.0, 0.0);
  });
  SceneView view = front_slice({.image = image});
  const auto beside_edge = [&] { return at(render_image(view, kSize, kSize).image, -0.03, 0.1); };
  EXPECT_EQ(beside_edge()[2], 0);
  view.tensors->smooth = true;
  EXPECT_GT(beside_edge()[2], 60);
}

/// An image of `value(x)` on a lattice, in single precision.
template <typename Value>
std::shared_ptr<const VolumeImage> scalar_image(const UniformTopology& lattice, const Value& value) {
  std::vector<float> values;
  for (int k = 0; k < lattice.points.z; ++k) {
    for (int j = 0; j < lattice.points.y; ++j) {
      for (int i = 0; i < lattice.points.x; ++i)
        values.push_back(static_cast<float>(value(lattice.origin + lattice.axes * Vec3(i, j, k))));
    }
  }
  DataSet block;
  block.topology = lattice;
  block.arrays.push_back(make_array("t1", Association::kPoint, 1, std::span<const float>(values)));
  return make_volume_image(block, "t1", "test");
}

// A linear function has one value at each place, however its image is turned and whatever its steps: shown
// below slices of another lattice, its greys are those of the function at the pixels' places.
TEST(SlicePicture, TheUnderlayIsSampledInItsOwnPlaceAndResolution) {
  const auto value = [](const Vec3& x) { return 100.0 + 40.0 * x.x + 25.0 * x.z - 10.0 * x.y; };
  const Mat3 turn(0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6);
  Mat3 oblique = turn;
  oblique[0] *= 0.07;
  oblique[1] *= 0.15;
  oblique[2] *= -0.11;  // left-handed
  const auto under = scalar_image(centred_lattice({71, 31, 43}, oblique), value);
  const auto lattice = make_slice_lattice(*scalar_image(centred_lattice({9, 9, 9}, Mat3(0.2)), value));
  SceneView view = front_slice({.image = lattice});
  view.tensors->smooth = true;
  view.tensors->underlay = UnderlayView{.image = under, .window = {.width = 160.0, .level = 100.0}};
  const Image picture = render_image(view, kSize, kSize).image;
  for (const double x : {-0.7, -0.1, 0.45, 0.8}) {
    for (const double z : {-0.75, 0.05, 0.6}) {
      const auto seen = at(picture, x, z);
      const double grey = 255.0 * (value({x, 0.0, z}) - 20.0) / 160.0;
      constexpr double kPixel =
          255.0 * 2.0 * (40.0 + 25.0) / 160.0 / kSize + 1.0;  // places are those of pixels
      for (const std::size_t c : {0U, 1U, 2U}) EXPECT_NEAR(seen[c], grey, kPixel) << x << " " << z;
    }
  }
}

TEST(SlicePicture, TensorsLieOverTheUnderlayAsTheBlendSays) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const Mat3 half = linear_tensor(Vec3(1.0, 0.0, 0.0));
  const auto image = sampled_tensors(centred_lattice({10, 10, 10}, Mat3(0.2)),
                                     [&](const Vec3& x) { return x.z > 0.6 ? Mat3(nothing) : half; });
  const auto under = scalar_image(centred_lattice({10, 10, 10}, Mat3(0.2)),
                                  [](const Vec3& x) { return x.x < 0.0 ? 0.5 : 0.25; });
  SceneView view = front_slice({.image = image});
  view.tensors->underlay = UnderlayView{.image = under, .window = {.width = 1.0, .level = 0.5}};
  // Of the tensor 1.7, 0.3, 0.3: FA by its definition.
  const double mean = 2.3 / 3.0;
  const double fa = std::sqrt(1.5 * ((1.7 - mean) * (1.7 - mean) + 2.0 * (0.3 - mean) * (0.3 - mean)) /
                              (1.7 * 1.7 + 2.0 * 0.3 * 0.3));
  const auto expect = [&](double x, double z, double red, double rest) {
    const auto seen = at(render_image(view, kSize, kSize).image, x, z);
    EXPECT_NEAR(seen[0], 255.0 * red, 1.5) << name_of(view.tensors->underlay->blend);
    EXPECT_NEAR(seen[1], 255.0 * rest, 1.5) << name_of(view.tensors->underlay->blend);
    EXPECT_NEAR(seen[2], 255.0 * rest, 1.5) << name_of(view.tensors->underlay->blend);
  };
  expect(-0.5, 0.1, fa + (1.0 - fa) * 0.5, (1.0 - fa) * 0.5);
  expect(0.5, 0.1, fa + (1.0 - fa) * 0.25, (1.0 - fa) * 0.25);
  expect(-0.5, 0.9, 0.5, 0.5);  // where there is no tensor, the image alone
  view.tensors->underlay->blend = UnderlayBlend::kSolid;
  expect(-0.5, 0.1, fa, 0.0);
  expect(0.5, 0.9, 0.25, 0.25);
  view.tensors->underlay->blend = UnderlayBlend::kNone;
  expect(-0.5, 0.1, 0.5, 0.5);
  view.tensors->underlay->blend = UnderlayBlend::kAnisotropy;
  view.tensors->color = TensorColor::kFa;
  expect(0.5, 0.1, fa + (1.0 - fa) * 0.25, fa + (1.0 - fa) * 0.25);
}

TEST(SlicePicture, TheUnderlayEndsWithItsVoxelsAndItsHoles) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const auto lattice = make_slice_lattice(
      *scalar_image(centred_lattice({10, 10, 10}, Mat3(0.2)), [](const Vec3&) { return 0.0; }));
  // Half as large as the slices, with a hole to the right.
  const auto under = scalar_image(centred_lattice({10, 10, 10}, Mat3(0.1)),
                                  [&](const Vec3& x) { return x.x > 0.2 ? nothing : 1.0; });
  SceneView view = front_slice({.image = lattice});
  view.tensors->underlay = UnderlayView{.image = under, .window = {.width = 1.0, .level = 0.5}};
  const Image picture = render_image(view, kSize, kSize).image;
  EXPECT_EQ(at(picture, -0.4, 0.3)[0], 255);
  EXPECT_TRUE(is_background(at(picture, 0.35, 0.3)));
  EXPECT_TRUE(is_background(at(picture, -0.6, 0.3)));
}

TEST(SlicePicture, CrosshairMarksThePosition) {
  const auto image =
      sampled_tensors(centred_lattice({10, 10, 10}, Mat3(0.2)), [&](const Vec3&) { return Mat3(1.0); });
  SceneView view = front_slice({.image = image, .position = {0.35, 0.0, -0.25}});
  const Image without = render_image(view, kSize, kSize).image;
  view.tensors->crosshair = true;
  const Image with = render_image(view, kSize, kSize).image;
  const auto brightest = [&](const Image& image_of, double x, double z) {
    const Pixel p = where(x, z);
    int most = 0;
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) most = std::max(most, image_of.pixel(p.x + dx, p.y + dy)[0]);
    }
    return most;
  };
  EXPECT_EQ(brightest(without, 0.35, 0.6), 0);
  EXPECT_GT(brightest(with, 0.35, 0.6), 60);
  EXPECT_GT(brightest(with, -0.6, -0.25), 60);
  EXPECT_EQ(brightest(with, -0.6, 0.6), 0);
}

TEST(GlyphPicture, GlyphsAreAsWideAsTheirTensors) {
  // One glyph fills the picture: 1 high, 0.5 wide.
  const auto image = sampled_tensors(centred_lattice({3, 3, 3}, Mat3(2.0)), [&](const Vec3& x) {
    return glm::length(x) < 0.5 ? Mat3{Vec3{0.5, 0.0, 0.0}, Vec3{0.0, 0.5, 0.0}, Vec3{0.0, 0.0, 1.0}}
                                : Mat3(0.0);
  });
  SceneView view = front_slice({.image = image});
  view.tensors->glyphs = GlyphShape::kEllipsoid;
  view.tensors->glyph_spacing = 1.0;
  const auto lit = [&](double x, double z) {
    return at(render_image(view, kSize, kSize).image, x, z)[2] > 120;  // blue: up
  };
  // In front of the slice's voxel, which is blue too but reaches farther: hidden where the glyph has ended.
  view.tensors->slices = {false, true, false};
  EXPECT_TRUE(lit(0.0, 0.9));
  EXPECT_TRUE(lit(0.45, 0.0));
  EXPECT_TRUE(lit(0.0, 0.0));
  const auto shade_at = [&](double x, double z) { return at(render_image(view, kSize, kSize).image, x, z); };
  const auto flat = shade_at(0.9, 0.9), beside = shade_at(0.6, 0.0);
  EXPECT_EQ(flat, beside);  // the slice
  EXPECT_NE(shade_at(0.42, 0.0), beside);
}

TEST(TensorBaseline, Slices) {
  SceneView view = tensor_scene(helix_image());
  view.tensors->position = {0.05, -0.05, 0.1};
  expect_baseline(view, "tensor_slices");
}

TEST(TensorBaseline, TurnedAndSmoothOnLight) {
  const Mat3 turn{Vec3{0.8, 0.6, 0.0}, Vec3{-0.6, 0.8, 0.0}, Vec3{0.2, 0.0, 1.0}};  // sheared as well
  SceneView view = tensor_scene(helix_image(turn));
  view.tensors->smooth = true;
  view.tensors->color = TensorColor::kFa;
  view.background = Background::kLight;
  expect_baseline(view, "tensor_turned");
}

TEST(TensorBaseline, Ellipsoids) {
  SceneView view = tensor_scene(helix_image());
  view.tensors->glyphs = GlyphShape::kEllipsoid;
  expect_baseline(view, "tensor_ellipsoids");
}

// From linear (left) over planar (right) to spherical (above).
TEST(TensorBaseline, Superquadrics) {
  const auto image = sampled_tensors(centred_lattice({7, 2, 4}, Mat3(0.3)), [](const Vec3& x) {
    const double planar = (x.x + 0.9) / 1.8, spherical = (x.z + 0.45) / 0.9;
    const Vec3 values = (1.0 - spherical) * Vec3(1.0, planar, 0.05) + spherical * Vec3(1.0);
    // Turned, so that three faces of each are seen.
    const Vec3 e1 = glm::normalize(Vec3(1.0, 0.5, 0.4)),
               e3 = glm::normalize(glm::cross(e1, Vec3(0.2, 0.5, 1.0)));
    const Mat3 frame{e1, glm::cross(e3, e1), e3};
    Mat3 sum{0.0};
    for (int i = 0; i < 3; ++i) sum += values[i] * glm::outerProduct(frame[i], frame[i]);
    return sum;
  });
  SceneView view = tensor_scene(image, {.azimuth = 0.0, .elevation = 0.0});
  view.show_outline = false;
  view.tensors->position = image->position({3.0, 0.0, 2.0});
  view.tensors->slices = {false, true, false};
  view.tensors->crosshair = false;
  view.tensors->glyphs = GlyphShape::kSuperquadric;
  view.tensors->glyph_least_fa = 0.0;
  view.tensors->glyph_spacing = 1.0;
  expect_baseline(view, "tensor_superquadrics");
}

TEST(TensorPicture, LocalRedrawOverSlicesIsTheSamePicture) {
  SceneView view = tensor_scene(helix_image());
  view.tensors->glyphs = GlyphShape::kEllipsoid;
  view.probe.emplace();
  view.probe->probe = view.probe->proxy = {0.1, 0.2, 0.3};
  OffscreenContext context;
  SceneRenderer renderer;
  renderer.draw(view, 160, 120);
  view.probe->probe = {0.4, -0.2, 0.1};
  view.tensors->position.z = 0.3;
  renderer.draw(view, 160, 120);
  const Image kept = renderer.read();
  SceneRenderer fresh;
  fresh.draw(view, 160, 120);
  EXPECT_EQ(worst_difference(kept, fresh.read()), 0);
}

}  // namespace
}  // namespace palpate::test
