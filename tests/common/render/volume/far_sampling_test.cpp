// Fewer samples far from the viewer, against the brute-force integrator and against all samples.

#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

#include "common/render/volume/volume_picture.h"
#include "tests/common/render/lens/sample_lenses.h"
#include "tests/support/reference_ray.h"

namespace palpate::test {
namespace {

constexpr int kSize = 80;
constexpr double kBound = 2.0 / 255.0;

// As many samples where the volume is farthest as are enough everywhere.
VolumeView far_view(bool shading) {
  VolumeView view = plain_view();
  view.samples_per_voxel = 16.0;
  view.far_sampling = 4.0;
  view.shading = shading;
  return view;
}

TEST(FarSampling, AgreesWithTheReferenceWhereItsFewestSamplesAreEnough) {
  VolumePicture picture(kSize, kSize);
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    VolumeView view = far_view(false);
    const Camera camera = camera_of(view, {}, projection);
    const Comparison result =
        compare(picture.draw(view, camera), ReferenceRay(view, camera, kSize, kSize, 50.0), kBound);
    EXPECT_LE(result.worst, kBound) << result.beyond_bound << " pixels";
    view.lenses = {lenses()[0].lens};
    view.lenses[0].samples_per_voxel = 16.0;
    const Comparison lensed =
        compare(picture.draw(view, camera), ReferenceRay(view, camera, kSize, kSize, 50.0), kBound);
    EXPECT_LE(lensed.worst, kBound) << lensed.beyond_bound << " pixels";
  }
}

// The inside of each lens is drawn as its outside is, far off, too.
TEST(FarSampling, LeavesNoSeamAtBordersOfLenses) {
  VolumePicture picture(kSize, kSize);
  for (const bool shading : {false, true}) {
    VolumeView view = far_view(shading);
    const FloatImage whole = picture.draw(view, camera_of(view));
    for (const auto& [name, lens] : lenses()) {
      Lens same{lens.shape};
      same.shading = shading;
      same.samples_per_voxel = view.samples_per_voxel;
      view.lenses = {same};
      EXPECT_LE(worst_difference(picture.draw(view, camera_of(view)), whole), 1.0 / 255.0) << name;
    }
  }
}

// At few samples the far half is off, the near half is not: seen from either side in turn.
TEST(FarSampling, ChangesWhatIsFarAndNotWhatIsNear) {
  VolumePicture picture(kSize, kSize);
  VolumeView view = sampled_view(shells, ScalarType::kFloat32, 29);
  view.samples_per_voxel = 1.0;
  const Camera camera = camera_of(view, {.azimuth = 0.0, .elevation = 0.0}, Projection::kOrthographic);
  const auto error_of_half = [&](double kept) {  // what lies beyond y = 0 on one side is cut away
    view.cuts = {{.kept = {{0.0, kept, 0.0}, 0.0}}};
    view.far_sampling = 1.0;
    const FloatImage all = picture.draw(view, camera);
    view.far_sampling = 8.0;
    return worst_difference(picture.draw(view, camera), all);
  };
  // From -y: with factor 8 in powers of two the near half has steps of 1 and 2, the far half of 2 and 4.
  EXPECT_LT(2.0 * error_of_half(1.0), error_of_half(-1.0));
  EXPECT_GT(error_of_half(-1.0), 0.01);
}

TEST(FarSampling, IsAnotherShaderOnlyWhereItIsAskedFor) {
  VolumePicture picture(16, 16);
  VolumeView view = plain_view();
  const FloatImage before = picture.draw(view, camera_of(view));
  view.far_sampling = 1.5;  // no two samples are joined
  EXPECT_EQ(worst_difference(picture.draw(view, camera_of(view)), before), 0.0);
}

}  // namespace
}  // namespace palpate::test
