// Voxels that are read where they stand look as those of a texture.
#include "common/render/volume/voxels/pinned_voxels.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "common/render/gl/context.h"
#include "common/render/volume/volume_picture.h"
#include "tests/common/render/lens/sample_lenses.h"

namespace palpate::test {
namespace {

constexpr int kSize = 64;
constexpr double kLevel = 1.0 / 255.0;

void expect_same(VolumeView view, const char* what) {
  VolumePicture texture(kSize, kSize);
  VolumePicture pinned(kSize, kSize, VolumePicture::Context::kCurrent);
  for (const double azimuth : {20.0, 160.0}) {
    const Camera camera = camera_of(view, {.azimuth = azimuth, .elevation = 25.0});
    const FloatImage expected = texture.draw(view, camera);
    VolumeView there = view;
    there.storage.least_pinned = 1;
    EXPECT_LE(worst_difference(pinned.draw(there, camera), expected), kLevel) << what << " " << azimuth;
    EXPECT_EQ(pinned.cost().voxel_bytes, 0U) << "a texture was made";
    EXPECT_GT(texture.cost().voxel_bytes, 0U);
  }
}

TEST(PinnedVoxels, LookAsATextureOfThem) {
  {
    const OffscreenContext context;
    if (!is_software_rasteriser()) GTEST_SKIP() << "the rasteriser has a memory of its own";
  }
  for (const ScalarType type : {ScalarType::kUint8, ScalarType::kInt8, ScalarType::kUint16,
                                ScalarType::kInt16, ScalarType::kFloat32}) {
    const bool sign = type != ScalarType::kUint8 && type != ScalarType::kUint16;
    VolumeView view = view_of(sampled_block(Index3(31, 22, 27), Vec3(0.06), type, [sign](const Vec3& x) {
      return sign ? 2.0 * blobs(x) - 1.0 : blobs(x);
    }));
    view.shading = true;
    expect_same(view, name_of(type));
  }
  for (const Index3& points : {Index3(1, 20, 17), Index3(30, 1, 2), Index3(9, 8, 1)})
    expect_same(view_of(sampled_block(points, Vec3(0.06), ScalarType::kUint16, blobs)), "thin");
  VolumeView lensed = view_of(sampled_block(Index3(31, 22, 27), Vec3(0.06), ScalarType::kInt16, blobs));
  Lens lens;
  lens.shape = make_sphere({0.1, 0.0, 0.2}, 0.4);
  lens.transfer = lensed.transfer;
  lensed.lenses.push_back(lens);
  lensed.context = {.viewport = 0.5, .level = 1};
  expect_same(lensed, "lens in a coarser context");
}

}  // namespace
}  // namespace palpate::test
