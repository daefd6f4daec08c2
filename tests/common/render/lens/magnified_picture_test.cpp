// Pictures of lenses that enlarge, against the brute-force integrator along bent rays.

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/render/lens/lens.h"
#include "common/render/volume/volume_picture.h"
#include "tests/common/render/lens/sample_lenses.h"
#include "tests/common/render/reference_agreement.h"

namespace palpate::test {
namespace {

constexpr Agreement kBar{.size = 48, .samples = 30.0, .exempt = 200};
constexpr int kSize = kBar.size;

/// Those that can enlarge, each doing so.
std::vector<NamedLens> magnifying() {
  std::vector<NamedLens> all;
  for (NamedLens one : lenses()) {
    one.lens.magnification = 2.5;
    if (magnifies(one.lens)) all.push_back(one);
  }
  return all;
}

TEST(LensPicture, AgreesWithTheReferenceWhereItEnlarges) {
  VolumePicture picture(kSize, kSize);
  ASSERT_EQ(magnifying().size(), 4U);  // all but the half-space
  for (const auto& [name, lens] : magnifying()) {
    VolumeView view = plain_view();
    view.lenses = {lens};
    view.lenses[0].transfer.reset();
    const Camera camera = camera_of(view);
    VolumeView plain = view;
    plain.lenses[0].magnification = 1.0;
    EXPECT_GT(worst_difference(picture.draw(view, camera), picture.draw(plain, camera)), 0.1) << name;
    expect_agreement(picture, view, camera, name, kBar);
    expect_agreement(picture, view,
                     camera_of(view, {.azimuth = 0.0, .elevation = 0.0}, Projection::kOrthographic),
                     name + ", along an axis", kBar);
    view.lenses[0].shading = view.shading = true;
    expect_agreement(picture, view, camera, name + ", under light", kBar);
  }
}

TEST(LensPicture, EnlargesFromInsideALens) {
  VolumePicture picture(kSize, kSize);
  for (const auto& [name, lens] : magnifying()) {
    VolumeView view = plain_view();
    view.lenses = {lens};
    Camera camera = camera_of(view);
    camera.focal_point = Vec3(0.05, 0.05, 0.0);
    camera.view_height = 0.1;
    ASSERT_TRUE(lens.shape.contains(eye(camera))) << name;
    expect_agreement(picture, view, camera, name, kBar);
  }
}

// At the border of the volume, where its faces bulge, and through another lens, which lies in front of it.
TEST(LensPicture, EnlargesAtTheBorderOfTheVolumeAndBehindAnotherLens) {
  VolumePicture picture(kSize, kSize);
  for (const auto& [name, lens] : magnifying()) {
    VolumeView view = plain_view();
    view.lenses = {lens};
    view.lenses[0].shape = moved(lens.shape, {0.7, -0.3, 0.8});
    expect_agreement(picture, view, camera_of(view), name + " at the border", kBar);
    view.lenses = {{make_sphere({0.3, -0.3, 0.0}, 0.3)}, lens};
    view.lenses[0].shading = false;
    expect_agreement(picture, view, camera_of(view), name + " behind a ball", kBar);
  }
}

// Grazed by rays, out of the volume, larger than it and without size.
TEST(LensPicture, EnlargesInLensesOfAnySize) {
  VolumePicture picture(kSize, kSize);
  const FloatImage whole = picture.draw(plain_view(), camera_of(plain_view()));
  for (const auto& [name, lens] : magnifying()) {
    VolumeView view = plain_view();
    view.lenses = {lens};
    view.lenses[0].transfer.reset();
    view.lenses[0].shape = scaled(lens.shape, 6.0);
    expect_agreement(picture, view, camera_of(view), name + ", large", kBar);
    view.lenses[0].shape = moved(lens.shape, {5.0, 0.0, 1.0});
    EXPECT_LE(worst_difference(picture.draw(view, camera_of(view)), whole), 0.5 / 255.0)
        << name << ", outside";
  }
  VolumeView view = plain_view();
  for (const ConvexShape& shape :
       {make_sphere(Vec3(0.0), 0.0), make_box(Vec3(0.0), Mat3(0.0)),
        make_cylinder({0.1, 0.0, 0.0}, {0.1, 0.0, 0.0}, 0.3), make_cylinder(Vec3(0.0), Vec3(1.0), 0.0),
        scaled(lenses()[4].lens.shape, 1e-9)}) {
    Lens lens{shape};
    lens.magnification = 3.0;
    view.lenses.push_back(lens);
  }
  EXPECT_LE(worst_difference(picture.draw(view, camera_of(view)), whole), 0.5 / 255.0);
}

// A face of the ball of radius r < 1/2 of the lens is seen as one of radius m r: an edge in the data stands
// where magnification says, whatever the integral along rays.
TEST(LensPicture, EnlargesItsCoreByItsMagnification) {
  constexpr double kBall = 0.12, kMagnification = 3.0;
  VolumePicture picture(kSize, kSize);
  VolumeView view = sampled_view([](const Vec3& x) { return glm::length(x); }, ScalarType::kFloat32, 65);
  view.transfer =
      ColorTransfer({{kBall - 1e-4, {1.0F, 1.0F, 1.0F}, 0.999}, {kBall + 1e-4, {1.0F, 1.0F, 1.0F}, 0.0}});
  view.table_entries = 1024;
  view.lenses = {{make_sphere(Vec3(0.0), 0.9)}};
  view.lenses[0].shading = false;
  view.lenses[0].magnification = kMagnification;
  const Camera camera = camera_of(view, {.azimuth = 0.0, .elevation = 0.0}, Projection::kOrthographic);
  const FloatImage image = picture.draw(view, camera);
  int covered = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) covered += image.at(x, y)[3] > 0.5 ? 1 : 0;
  }
  const double pixel = camera.view_height / kSize;
  EXPECT_NEAR(std::sqrt(covered * pixel * pixel / std::numbers::pi), kMagnification * kBall, 0.02);
}

TEST(LensPicture, CompilesTheShaderThatEnlargesOnlyForLensesThatDo) {
  VolumePicture picture(16, 16);
  VolumeView view = plain_view();
  view.lenses = {{make_sphere(Vec3(0.0), 0.5)}};
  (void)picture.draw(view, camera_of(view));
  const int programs = picture.cost().programs;
  view.lenses[0].magnification = 2.0;
  (void)picture.draw(view, camera_of(view));
  EXPECT_EQ(picture.cost().programs, programs + 1);
  view.lenses[0].cut = true;
  (void)picture.draw(view, camera_of(view));
  EXPECT_EQ(picture.cost().programs, programs + 1);
}

}  // namespace
}  // namespace palpate::test
