// Pictures of volumes kept beside the tests, looked at by people.

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/render/volume/value_gradient.h"
#include "tests/common/render/picture_checks.h"
#include "tests/common/render/volume/sample_volumes.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

SceneView scene_of(VolumeView volume) {
  SceneView view;
  view.bounds = volume.image->bounds();
  view.camera = make_camera(view.bounds, {}, 4.0 / 3.0);
  view.show_axes = view.show_color_bar = false;
  view.volume = std::move(volume);
  return view;
}

VolumeView lit_blobs() {
  VolumeView volume = sampled_view(blobs);
  volume.shading = true;
  return volume;
}

TEST(VolumeBaseline, Blobs) { expect_baseline(scene_of(lit_blobs()), "volume_blobs"); }

TEST(VolumeBaseline, MarschnerLobb) {
  VolumeView volume = sampled_view(marschner_lobb, ScalarType::kFloat32, 41);
  volume.shading = true;
  volume.transfer = ColorTransfer({{0.48, {0.9F, 0.8F, 0.5F}, 0.0}, {0.52, {0.9F, 0.8F, 0.5F}, 0.4}});
  expect_baseline(scene_of(volume), "volume_marschner_lobb");
}

// A sphere without light in another transfer function, and half of the front cut away.
TEST(VolumeBaseline, Lenses) {
  VolumeView volume = lit_blobs();
  Lens focus{make_sphere({-0.25, -0.2, 0.1}, 0.5)}, cut{make_half_space({0.15, 0.0, 0.0}, {-1.0, 0.3, 0.0})};
  focus.transfer = ColorTransfer(
      {{0.3, {0.2F, 0.9F, 0.9F}, 0.02}, {0.6, {0.9F, 0.9F, 0.2F}, 0.0}, {1.0, Vec3f(1.0F), 0.1}});
  focus.shading = false;
  cut.cut = true;
  volume.lenses = {focus, cut};
  expect_baseline(scene_of(volume), "volume_lenses");
}

// The middle three times as large, on its way back to its place toward the border of a cylinder.
TEST(VolumeBaseline, Magnified) {
  VolumeView volume = lit_blobs();
  Lens lens{make_cylinder({-0.5, -0.8, 0.0}, {0.2, 0.8, 0.1}, 0.55)};
  lens.magnification = 3.0;
  volume.lenses = {lens};
  expect_baseline(scene_of(volume), "volume_magnified");
}

// Lines go in and out of matter: each pixel of a line ends its ray.
TEST(VolumeBaseline, LinesInside) {
  SceneView view = scene_of(lit_blobs());
  std::vector<Line> lines;
  for (int i = 0; i < 3; ++i) {
    Line line;
    for (int k = 0; k <= 60; ++k) {
      const double a = 0.2 * k, z = -1.0 + k / 30.0;
      LinePoint point;
      point.position = Vec3((0.2 + 0.3 * i) * std::cos(a), (0.2 + 0.3 * i) * std::sin(a), z);
      point.time = k;
      line.points.push_back(point);
    }
    lines.push_back(line);
  }
  view.lines = std::make_shared<const std::vector<Line>>(std::move(lines));
  view.style.color_by = ColorBy::kUniform;
  view.style.width = 12.0;
  expect_baseline(view, "volume_lines");
}

// Around the lens by value, in it the borders of another field, where its values change fast.
TEST(VolumeBaseline, AnotherFieldByRegions) {
  VolumeView volume = lit_blobs();
  volume.fields = {{sampled_view(shells, ScalarType::kFloat32, 41).image, "shells"}};
  Lens lens{make_sphere({0.1, -0.4, 0.1}, 0.6)};
  lens.field = 1;
  lens.regions = spread(RegionTransfer({{.shape = TransferRegion::Shape::kTriangle,
                                         .corners = {Vec2(0.5, 0.1), Vec2(0.2, 1.0), Vec2(0.8, 1.0)},
                                         .color = {0.3F, 0.9F, 0.5F},
                                         .opacity = 0.15,
                                         .soft = 0.6}}),
                        place_range(*volume.fields[0].image));
  volume.lenses = {lens};
  expect_baseline(scene_of(volume), "volume_another_field");
}

class ToothBaseline : public testing::Test {
 protected:
  static std::vector<std::uint16_t> read(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    std::vector<std::uint16_t> numbers;
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {  // big endian
      numbers.push_back(static_cast<std::uint16_t>(static_cast<unsigned char>(bytes[i]) << 8U |
                                                   static_cast<unsigned char>(bytes[i + 1])));
    }
    return numbers;
  }

  static VolumeView view_of_tooth(std::vector<std::uint16_t> numbers) {
    VolumeView volume = view_of(block_of({103, 94, 161}, Vec3(1.0), std::move(numbers), ScalarType::kUint16));
    volume.shading = true;
    volume.samples_per_voxel = 2.0;
    return volume;
  }
};

TEST_F(ToothBaseline, ByValue) {
  PALPATE_NEED_DATA(file, "grid/tooth/tooth.raw");
  std::vector<std::uint16_t> numbers = read(file);
  ASSERT_EQ(numbers.size(), 103U * 94U * 161U);
  VolumeView volume = view_of_tooth(std::move(numbers));
  volume.transfer = ColorTransfer({{500.0, {0.6F, 0.3F, 0.2F}, 0.0},
                                   {800.0, {0.9F, 0.6F, 0.3F}, 0.08},
                                   {1000.0, {1.0F, 0.9F, 0.7F}, 0.1},
                                   {1300.0, {1.0F, 1.0F, 1.0F}, 0.5}});
  expect_baseline(scene_of(volume), "volume_tooth");
}

// What values alone do not part: the borders of dentin and enamel, the pulp between.
TEST_F(ToothBaseline, ByValueAndGradient) {
  PALPATE_NEED_DATA(file, "grid/tooth/tooth.raw");
  std::vector<std::uint16_t> numbers = read(file);
  ASSERT_EQ(numbers.size(), 103U * 94U * 161U);
  VolumeView volume = view_of_tooth(std::move(numbers));
  volume.regions = spread(boundary_regions(), place_range(*volume.image));
  expect_baseline(scene_of(volume), "volume_tooth_boundaries");
}

}  // namespace
}  // namespace palpate::test
