// Anisotropy as a volume, with directions as colours in a lens: numbers, pixels that are known, and a picture
// kept beside the tests, looked at by people.

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "common/render/gl/context.h"
#include "common/render/scene_renderer.h"
#include "common/render/tensor/tensor_voxels.h"
#include "tests/common/render/picture_checks.h"
#include "tests/common/render/tensor/sample_tensors.h"
#include "tests/support/half_space.h"

namespace palpate::test {
namespace {

std::shared_ptr<const TensorVoxels> helix_image() {
  return sampled_tensors(centred_lattice({21, 21, 21}, Mat3(0.1)), helix_tensor);
}

TEST(AnisotropyVolume, HasTheAnisotropyAndTheDirectionOfEachVoxel) {
  const auto voxels = helix_image();
  const auto volume = make_anisotropy_volume(voxels);
  EXPECT_EQ(volume->points, voxels->points);
  EXPECT_EQ(volume->origin, voxels->origin);
  EXPECT_EQ(volume->axes, voxels->axes);
  EXPECT_EQ(volume->lowest, 0.0);
  EXPECT_GT(volume->highest, 0.7);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < volume->point_count(); ++i) {
    EXPECT_DOUBLE_EQ(volume->value(i), voxels->anisotropies[i] / 255.0);
    if (voxels->anisotropies[i] < 128) continue;
    // Unit directions again: |x| |y| |z| of bytes.
    const auto& c = (*volume->colors)[i];
    EXPECT_NEAR(std::hypot(c[0], c[1], c[2]), 255.0, 3.0);
    ++seen;
  }
  EXPECT_GT(seen, 100U);
}

// Two blocks along x and z; the lens holds the right one alone.
TEST(AnisotropyVolume, ShowsDirectionsInTheLensAloneAndGreyOutside) {
  const auto voxels = sampled_tensors(centred_lattice({11, 11, 11}, Mat3(0.2)), [](const Vec3& x) {
    return linear_tensor(x.x < 0.0 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 0.0, 1.0));
  });
  SceneView view = front_view({});
  VolumeView volume;
  volume.image = make_anisotropy_volume(voxels);
  volume.transfer = ColorTransfer({{0.0, Vec3f(0.5F), 0.9}});
  volume.shading = false;
  Lens lens{make_sphere({0.5, 0.0, 0.0}, 0.45)};
  lens.transfer = anisotropy_body();
  lens.shading = false;
  lens.colored = true;
  volume.lenses = {lens};
  // What lies before the lens is cut away.
  Lens cut{make_half_space({0.0, -0.2, 0.0}, {0.0, 1.0, 0.0})};
  cut.cut = true;
  volume.lenses.insert(volume.lenses.begin(), cut);
  view.volume = volume;
  const Image picture = render_image(view, kSize, kSize).image;
  const auto left = at(picture, -0.5, 0.1), right = at(picture, 0.5, 0.1);
  EXPECT_NEAR(left[0], left[1], 2);
  EXPECT_NEAR(left[1], left[2], 2);
  EXPECT_GT(right[2], 240);
  EXPECT_LT(right[0], 12);
  view.volume->shown = false;
  EXPECT_TRUE(is_background(at(render_image(view, kSize, kSize).image, -0.5, 0.1)));
}

TEST(AnisotropyVolume, LooksAsItDid) {
  SceneView view;
  const auto voxels = helix_image();
  view.bounds = voxels->bounds();
  view.camera = make_camera(view.bounds, {}, 4.0 / 3.0);
  view.show_axes = view.show_color_bar = false;
  view.tensors = TensorView{.image = voxels};
  view.tensors->slices = {false, false, true};
  view.tensors->crosshair = false;
  VolumeView volume;
  volume.image = make_anisotropy_volume(voxels);
  volume.transfer = anisotropy_veil();
  volume.opacity_length = 0.02;
  Lens lens{make_sphere({0.3, -0.3, 0.3}, 0.75)};
  lens.transfer = anisotropy_body();
  lens.colored = true;
  volume.lenses = {lens};
  view.volume = volume;
  view.volume_label = "FA";
  expect_baseline(view, "tensor_volume_lens");
}

}  // namespace
}  // namespace palpate::test
