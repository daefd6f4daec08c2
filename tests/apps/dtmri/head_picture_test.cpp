// Pictures of a real head, from its diffusion-weighted series: slices coloured by direction, and a volume of
// anisotropy with directions in a lens. Colours are held against anatomy; the pictures are kept beside the
// tests, looked at by people.

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "apps/dtmri/tensor_scene.h"
#include "tests/common/render/picture_checks.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

constexpr int kWidth = 480, kHeight = 360;

/// Seen from above: right on the right, front at the top.
SceneView head_from_above(const std::filesystem::path& file, const Document& options) {
  Input input = Input::open(input_of({file}, FieldKind::kTensor));
  auto voxels = make_tensor_voxels(input.load_tensor(2), input.title(), 2);
  SceneView view = make_tensor_scene(
      input, {.tensors = make_tensor_view(std::move(voxels), options.tensors), .tracts = {}}, options,
      static_cast<double>(kWidth) / kHeight);
  view.tensors->crosshair = false;
  view.show_axes = view.show_color_bar = view.show_outline = false;
  view.title = view.subtitle = "";
  return view;
}

Document from_above() {
  Document options;
  options.view.camera = "0,90,0,1";
  options.volume.projection = "orthographic";
  return options;
}

/// Mean colour of the voxels about a place.
std::array<double, 3> color_about(const Image& picture, const SceneView& view, const Vec3& place) {
  constexpr double kStep = 3.0;  // a voxel [mm]
  std::array<double, 3> sum{};
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 1; ++j) {
      const Vec3 at = project(view.camera, place + kStep * Vec3(i, j, 0.0), picture.width, picture.height);
      const auto pixel = picture.pixel(static_cast<int>(at.x), static_cast<int>(at.y));
      for (std::size_t c = 0; c < 3; ++c) sum[c] += pixel[c] / 9.0;
    }
  }
  return sum;
}

/// The corpus callosum crosses the middle before and behind the ventricles, the pyramidal tracts run through
/// the internal capsules, in this scan's coordinates [mm].
void expect_anatomy(const SceneView& view) {
  const Image picture = render_image(view, kWidth, kHeight).image;
  for (const Vec3& callosum : {Vec3(0.0, -4.0, 30.0), Vec3(0.0, 57.0, 30.0)}) {
    const auto [red, green, blue] = color_about(picture, view, callosum);
    EXPECT_GT(red, 1.3 * std::max(green, blue)) << "at y = " << callosum.y;
  }
  for (const double x : {-24.0, 23.0}) {
    const auto [red, green, blue] = color_about(picture, view, Vec3(x, 12.0, 30.0));
    EXPECT_GT(blue, 1.3 * std::max(red, green)) << "at x = " << x;
  }
}

TEST(HeadPicture, OfASliceHasARedCorpusCallosumAndBluePyramidalTracts) {
  PALPATE_NEED_DATA(file, "dtmri/brain-dwi/3000_DTI_PA-ortho_cl.nii.gz");
  Document options = from_above();
  options.tensors.slices = "-,-,30";
  const SceneView view = head_from_above(file, options);
  EXPECT_FALSE(view.volume->shown);
  expect_anatomy(view);
  expect_baseline(view, "head_slice");
}

TEST(HeadPicture, OfAVolumeHasDirectionsInTheLensAndGreyOutside) {
  PALPATE_NEED_DATA(file, "dtmri/brain-dwi/3000_DTI_PA-ortho_cl.nii.gz");
  Document options = from_above();
  options.tensors.slices = "none";
  options.volume.lenses = {"cylinder:0,26,-40,0,26,80,45"};
  options.volume.clips = {"0,0,1,31"};
  const SceneView view = head_from_above(file, options);
  EXPECT_TRUE(view.volume->shown);
  expect_anatomy(view);
  // Beside the lens all is grey.
  const Image picture = render_image(view, kWidth, kHeight).image;
  for (const double x : {-58.0, 58.0}) {
    const auto color = color_about(picture, view, Vec3(x, 20.0, 20.0));
    EXPECT_LT(*std::max_element(color.begin(), color.end()) - *std::min_element(color.begin(), color.end()),
              12.0);
  }
  expect_baseline(view, "head_lens");
}

}  // namespace
}  // namespace palpate::test
