// Pictures by value and gradient magnitude, against the brute-force integrator.

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/math/power_of_two.h"
#include "common/render/volume/volume_picture.h"
#include "common/render/volume/voxels/value_gradient.h"
#include "tests/common/render/lens/sample_lenses.h"
#include "tests/common/render/reference_agreement.h"

namespace palpate::test {
namespace {

constexpr int kSize = Agreement{}.size;

// One region of each shape in fractions of the ranges of values and of gradient magnitudes: an even core, a
// border that is seen where values change fast, and a triangle that opens towards it.
RegionTransfer three_regions() {
  using Shape = TransferRegion::Shape;
  return RegionTransfer({{.shape = Shape::kEllipse,
                          .corners = {Vec2(0.7, -0.3), Vec2(1.1, 0.3), Vec2(0.0)},
                          .color = {0.2F, 0.9F, 0.3F},
                          .opacity = 0.2,
                          .soft = 0.8},
                         {.shape = Shape::kBox,
                          .corners = {Vec2(0.25, 0.55), Vec2(0.55, 1.2), Vec2(0.0)},
                          .color = {1.0F, 0.4F, 0.1F},
                          .opacity = 0.15,
                          .soft = 0.5},
                         {.shape = Shape::kTriangle,
                          .corners = {Vec2(0.55, 0.05), Vec2(0.45, 0.8), Vec2(0.9, 0.7)},
                          .color = {0.3F, 0.4F, 1.0F},
                          .opacity = 0.1,
                          .soft = 0.6}});
}

RegionTransfer regions_for(const VolumeImage& image) { return spread(three_regions(), place_range(image)); }

VolumeView region_view(const Formula& formula, ScalarType type = ScalarType::kFloat32, int points = 33) {
  VolumeView view = sampled_view(formula, type, points);
  view.regions = regions_for(*view.image);
  return view;
}

double most_opaque(const FloatImage& image) {
  double most = 0.0;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4)
    most = std::max(most, static_cast<double>(image.rgba[i]));
  return most;
}

TEST(RegionPicture, AgreesWithTheReferenceForEveryTypeOfVoxelsAndUnderLight) {
  VolumePicture picture(kSize, kSize);
  for (const ScalarType type : {ScalarType::kUint8, ScalarType::kUint16, ScalarType::kFloat32}) {
    VolumeView view = region_view(blobs, type);
    const Camera camera = camera_of(view);
    EXPECT_GT(most_opaque(picture.draw(view, camera)), 0.3);
    expect_agreement(picture, view, camera, name_of(type));
  }
  const VolumeView round = region_view(shells);
  expect_agreement(picture, round, camera_of(round), "shells");
  VolumeView lit = region_view(blobs);
  lit.shading = true;
  expect_agreement(picture, lit, camera_of(lit), "lit");
  expect_agreement(picture, lit,
                   camera_of(lit, {.azimuth = 0.0, .elevation = 0.5}, Projection::kOrthographic),
                   "lit, grazing");
}

// In a lens and around it, with the other kind of transfer function or the same one; cut; enlarged.
TEST(RegionPicture, AgreesWithTheReferenceInLensesAroundThemAndWherePlanesCut) {
  VolumePicture picture(kSize, kSize);
  VolumeView view = plain_view();
  const RegionTransfer regions = regions_for(*view.image);
  const CuttingPlane cut{.kept = {glm::normalize(Vec3(1.0, 2.0, -0.5)), 0.3}};
  for (const std::size_t shape : {0U, 1U, 3U}) {
    view.lenses = {lenses()[shape].lens};
    view.lenses[0].transfer.reset();
    view.lenses[0].regions = regions;
    view.regions.reset();
    view.cuts = {cut};
    expect_agreement(picture, view, camera_of(view), lenses()[shape].name + " inside");
    view.cuts.clear();
    view.lenses[0].transfer = focus_colors();
    view.lenses[0].regions.reset();
    view.regions = regions;
    expect_agreement(picture, view, camera_of(view), lenses()[shape].name + " outside");
  }
  view.lenses = {lenses()[0].lens};
  view.lenses[0].regions = regions;
  view.lenses[0].magnification = 2.0;
  view.lenses[0].shading = true;
  view.regions.reset();
  expect_agreement(picture, view, camera_of(view), "enlarged");
}

TEST(RegionPicture, SplitsRaysWithoutATrace) {
  VolumePicture picture(kSize, kSize);
  VolumeView view = region_view(blobs);
  for (const bool shading : {false, true}) {
    view.shading = shading;
    view.lenses.clear();
    const FloatImage whole = picture.draw(view, camera_of(view));
    view.lenses = {Lens{lenses()[1].lens.shape}};
    view.lenses[0].shading = shading;
    EXPECT_LE(worst_difference(picture.draw(view, camera_of(view)), whole), 1.0 / 255.0) << shading;
  }
}

// Bricks are empty by their values and gradients together: more of them than by the values alone.
TEST(RegionPicture, LeapsOverWhatHasNoSuchGradient) {
  VolumePicture picture(kSize, kSize);
  VolumeView view =
      sampled_view([](const Vec3& x) { return 1.0 / (1.0 + std::exp(30.0 * (glm::length(x) - 0.6))); },
                   ScalarType::kFloat32, 65);
  // Values of the inside, which is all even, with a gradient that only its border has.
  view.regions = spread(RegionTransfer({{.corners = {Vec2(0.05, 0.2), Vec2(1.2, 1.5), Vec2(0.0)}}}),
                        place_range(*view.image));
  const FloatImage leaping = picture.draw(view, camera_of(view));
  EXPECT_GT(picture.cost().empty_share, 0.6);
  EXPECT_GT(most_opaque(leaping), 0.5);
  view.skip_empty = false;
  EXPECT_LT(worst_difference(picture.draw(view, camera_of(view)), leaping), 0.5 / 255.0);
  view.storage.brick_cells = 16;
  for (const bool skip : {false, true}) {
    view.skip_empty = skip;
    EXPECT_LT(worst_difference(picture.draw(view, camera_of(view)), leaping), 1.0 / 255.0) << "in bricks";
  }
}

TEST(RegionPicture, AgreesWithTheReferenceOnLongVoxelsAndSheets) {
  VolumePicture picture(kSize, kSize);
  for (int axis = 0; axis < 3; axis += 2) {
    Vec3 spacing(0.001);
    Index3 points(33);
    spacing[axis] = 1.0;
    points[axis] = 17;
    VolumeView view = view_of(sampled_block(points, spacing, ScalarType::kFloat32, blobs));
    view.regions = regions_for(*view.image);
    Camera camera = camera_of(view, {.azimuth = 20.0, .elevation = 10.0});
    camera.view_height = 0.06;  // the thin side fills the picture
    expect_agreement(picture, view, camera, "a thousand times as long as wide");
  }
  VolumeView sheet = view_of(sampled_block({33, 33, 1}, Vec3(0.06), ScalarType::kFloat32, blobs));
  sheet.regions = regions_for(*sheet.image);
  expect_agreement(picture, sheet, camera_of(sheet), "one voxel thin");
}

TEST(RegionPicture, ShowsNothingNextToNan) {
  const DataSet block = sampled_block(Index3(17), Vec3(0.125), ScalarType::kFloat32, [](const Vec3& x) {
    return x.x > 0.3 ? std::numeric_limits<double>::quiet_NaN() : 0.4 * x.x + 0.5;
  });
  VolumeView view = view_of(block);
  view.regions =
      spread(RegionTransfer({{.corners = {Vec2(-1.0, -1.0), Vec2(2.0, 2.0), Vec2(0.0)}, .soft = 0.0}}),
             place_range(*view.image));
  VolumePicture picture(kSize, kSize);
  const Camera camera = camera_of(view, {.azimuth = 0.0, .elevation = 0.0}, Projection::kOrthographic);
  for (const bool shading : {false, true}) {
    view.shading = shading;
    const FloatImage image = picture.draw(view, camera);
    for (const float part : image.rgba) ASSERT_TRUE(std::isfinite(part));
    EXPECT_GT(image.at(kSize / 4, kSize / 2)[3], 0.5);
    EXPECT_EQ(image.at(3 * kSize / 4, kSize / 2)[3], 0.0);
  }
}

TEST(RegionPicture, IsTheSameBitsAtAnyPowerOfTwo) {
  VolumePicture picture(kSize, kSize);
  VolumeView view = region_view(blobs);
  view.shading = true;
  const FloatImage usual = picture.draw(view, camera_of(view));
  for (const int values : {-60, 70}) {
    for (const int lengths : {-40, 90}) {
      const double unit = power_of_two(values);
      VolumeView scaled = view_of(sampled_block(
          Index3(33), Vec3(power_of_two(lengths) * 2.0 / 32), ScalarType::kFloat32,
          [&](const Vec3& x) { return unit * static_cast<double>(static_cast<float>(blobs(x))); }));
      scaled.shading = true;
      scaled.regions = regions_for(*scaled.image);
      EXPECT_EQ(worst_difference(picture.draw(scaled, camera_of(scaled)), usual), 0.0)
          << values << ' ' << lengths;
    }
  }
}

}  // namespace
}  // namespace palpate::test
