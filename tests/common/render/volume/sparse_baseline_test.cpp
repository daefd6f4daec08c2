// The built-in sparse volume as a picture kept beside the tests, looked at by people.
#include <gtest/gtest.h>

#include "common/field/analytic/volume_examples.h"
#include "common/render/volume/voxels/volume_image.h"
#include "tests/common/render/picture_checks.h"

namespace palpate::test {
namespace {

// 1024^3 voxels, cut open, through 96 MB of voxels: a coarser volume in bricks.
TEST(SparseBaseline, SparseShells) {
  const DataSet block = volume_example("sparse-shells");
  VolumeView volume;
  volume.image = make_volume_image(block, block.arrays.front().name, "sparse-shells");
  ASSERT_NE(volume.image->sparse, nullptr);
  volume.shading = true;
  volume.opacity_length = 0.01;
  volume.transfer = ColorTransfer({{0.03, {0.3F, 0.5F, 0.9F}, 0.0},
                                   {0.15, {0.5F, 0.7F, 0.9F}, 0.4},
                                   {0.3, {0.9F, 0.6F, 0.3F}, 0.7},
                                   {0.6, {1.0F, 0.95F, 0.7F}, 0.9}});
  volume.storage.memory = std::uint64_t{96} << 20U;
  volume.cuts = {{{{1.0, 0.0, 0.0}, 0.35}}};
  SceneView view;
  view.bounds = volume.image->bounds();
  view.camera = make_camera(view.bounds, {}, 4.0 / 3.0);
  view.show_axes = view.show_color_bar = false;
  view.volume = std::move(volume);
  expect_baseline(view, "volume_sparse_shells");
}

}  // namespace
}  // namespace palpate::test
