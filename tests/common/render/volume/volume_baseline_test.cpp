// Pictures of volumes kept beside the tests, looked at by people; those of every feature stand in
// volume_sheets_test.cpp.

#include <gtest/gtest.h>

#include "tests/common/render/picture_checks.h"
#include "tests/common/render/volume/sample_volumes.h"

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

}  // namespace
}  // namespace palpate::test
