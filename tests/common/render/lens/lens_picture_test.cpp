// Pictures of volumes with lenses, against the brute-force integrator and against pictures without.

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/render/lens/lens.h"
#include "common/render/volume/volume_picture.h"
#include "tests/common/render/lens/sample_lenses.h"
#include "tests/support/reference_ray.h"

namespace palpate::test {
namespace {

constexpr int kSize = 80;
constexpr double kSamples = 40.0;  // a voxel, of a reference ray
constexpr double kBound = 2.0 / 255.0;

void expect_agreement(VolumePicture& picture, const VolumeView& view, const Camera& camera,
                      const std::string& what) {
  const Comparison result =
      compare(picture.draw(view, camera), ReferenceRay(view, camera, kSize, kSize, kSamples), kBound);
  EXPECT_LE(result.worst, kBound) << what << ": " << result.beyond_bound << " pixels";
  EXPECT_LE(result.exempt, kSize * kSize / 500) << what;
}

TEST(LensPicture, AgreesWithTheReferenceForEveryShape) {
  VolumePicture picture(kSize, kSize);
  for (const auto& [name, lens] : lenses()) {
    VolumeView view = plain_view();
    view.lenses = {lens};
    const Camera camera = camera_of(view);
    EXPECT_GT(worst_difference(picture.draw(view, camera), picture.draw(plain_view(), camera)), 0.1) << name;
    expect_agreement(picture, view, camera, name);
    view.lenses[0].cut = true;
    expect_agreement(picture, view, camera, name + ", cut away");
    view.lenses[0].cut = false;
    // Along the axes, where rays graze the faces of the box, the axis of nothing and the border of the
    // volume.
    expect_agreement(picture, view,
                     camera_of(view, {.azimuth = 0.0, .elevation = 0.0}, Projection::kOrthographic),
                     name + ", along an axis");
  }
}

TEST(LensPicture, AgreesWithTheReferenceUnderLight) {
  VolumeView view = plain_view();
  view.shading = true;
  view.lenses = {lenses()[0].lens, lenses()[2].lens};
  view.lenses[1].shading = true;
  VolumePicture picture(kSize, kSize);
  expect_agreement(picture, view, camera_of(view), "one of two shaded");
}

TEST(LensPicture, AgreesWithTheReferenceFromInsideALens) {
  VolumePicture picture(kSize, kSize);
  for (const auto& [name, lens] : lenses()) {
    VolumeView view = plain_view();
    view.lenses = {lens};
    Camera camera = camera_of(view);
    camera.focal_point = Vec3(0.05, 0.05, 0.0);
    camera.view_height = 0.1;
    ASSERT_TRUE(lens.shape.contains(eye(camera)) || name == "half-space") << name;
    expect_agreement(picture, view, camera, name);
  }
}

TEST(LensPicture, OfLensesThatOverlapShowsTheFirst) {
  VolumePicture picture(kSize, kSize);
  VolumeView view = plain_view();
  Lens first{make_sphere({0.2, 0.0, 0.0}, 0.5)}, second{make_box({-0.1, 0.0, 0.1}, Mat3(0.5))};
  Lens third{make_cylinder({0.0, -0.9, 0.0}, {0.0, 0.9, 0.0}, 0.2)};
  first.transfer = focus_colors();
  first.shading = second.shading = third.shading = false;
  second.cut = true;
  third.transfer = ColorTransfer({{0.0, {1.0F, 0.0F, 0.0F}, 0.01}});
  for (const std::vector<Lens>& order :
       {std::vector<Lens>{first, second, third}, {third, second, first}, {second, first, third}}) {
    view.lenses = order;
    expect_agreement(picture, view, camera_of(view), "three lenses");
  }
}

// The inside of each lens is drawn as its outside is: the ray is split, and nothing is to be seen of it.
TEST(LensPicture, SplitsRaysWithoutATrace) {
  VolumePicture picture(kSize, kSize);
  for (const bool shading : {false, true}) {
    VolumeView view = plain_view();
    view.shading = shading;
    const Camera camera = camera_of(view);
    const FloatImage whole = picture.draw(view, camera);
    for (const auto& [name, lens] : lenses()) {
      Lens same{lens.shape};
      same.shading = shading;
      view.lenses = {same};
      EXPECT_LE(worst_difference(picture.draw(view, camera), whole), 1.0 / 255.0) << name << " " << shading;
    }
  }
}

TEST(LensPicture, OfLensesWithoutMatterIsThatWithoutLens) {
  VolumePicture picture(kSize, kSize);
  VolumeView view = plain_view();
  const Camera camera = camera_of(view);
  const FloatImage whole = picture.draw(view, camera);
  Lens nothing{make_sphere(Vec3(0.0), 0.0)}, outside{make_sphere({5.0, 0.0, 0.0}, 2.0)};
  nothing.cut = outside.cut = true;
  view.lenses = {nothing, outside};
  // With lenses a ray ends at the very step at which it is opaque, without them at every other one.
  EXPECT_LE(worst_difference(picture.draw(view, camera), whole), 0.5 / 255.0);
}

TEST(LensPicture, OfALensLargerThanTheVolumeIsAllFocus) {
  VolumePicture picture(kSize, kSize);
  VolumeView view = plain_view();
  const Camera camera = camera_of(view);
  view.transfer = focus_colors();
  const FloatImage whole = picture.draw(view, camera);
  VolumeView through = plain_view();
  through.lenses = {Lens{make_sphere(Vec3(0.0), 4.0)}};
  through.lenses[0].transfer = focus_colors();
  through.lenses[0].shading = false;
  // Its table spreads over the values of both functions: other entries, and as near to the truth.
  EXPECT_LE(worst_difference(picture.draw(through, camera), whole), kBound);
}

TEST(LensPicture, HoldsAsManyLensesAsThereMayBe) {
  VolumePicture picture(kSize, kSize);
  VolumeView view = plain_view();
  for (std::size_t i = 0; i < kMostLenses; ++i) {
    Lens lens{make_sphere(Vec3(-0.8 + 0.22 * static_cast<double>(i), 0.1, 0.0), 0.2)};
    lens.transfer = ColorTransfer({{0.0, Vec3f(static_cast<float>(i) / kMostLenses, 0.5F, 0.2F), 0.03}});
    lens.shading = false;
    view.lenses.push_back(lens);
  }
  expect_agreement(picture, view, camera_of(view), "eight lenses");
}

/// The view with `color(x)` at each of its points.
template <typename Color>
VolumeView with_colors(VolumeView view, const Color& color) {
  auto image = std::make_shared<VolumeImage>(*view.image);
  std::vector<std::array<std::uint8_t, 4>> colors;
  const Index3 n = image->points;
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) {
      for (int x = 0; x < n.x; ++x) colors.push_back(color(image->origin + image->axes * Vec3(x, y, z)));
    }
  }
  image->colors = std::make_shared<const std::vector<std::array<std::uint8_t, 4>>>(std::move(colors));
  view.image = std::move(image);
  return view;
}

// A transfer function of one colour and voxels of that colour are the same picture, lit or not, and the
// opacities are those of the transfer function.
TEST(LensPicture, VoxelsOfOneColourLookLikeATransferFunctionOfThatColour) {
  const Vec3f tone(0.2F, 0.6F, 1.0F);
  const auto in_tone = [&](std::vector<ColorPoint> points) {
    for (ColorPoint& point : points) point.color = tone;
    return ColorTransfer(std::move(points));
  };
  VolumePicture picture(kSize, kSize);
  // In the lens without light, outside it with light.
  for (const bool lit : {false, true}) {
    VolumeView view = with_colors(plain_view(), [](const Vec3&) {
      return std::array<std::uint8_t, 4>{51, 153, 255, 0};
    });
    Lens lens{make_sphere({0.1, -0.2, 0.2}, 0.6)};
    lens.transfer = focus_colors();
    lens.shading = view.shading = lit;
    view.lenses = {lens};
    VolumeView toned = view;
    if (lit) {
      view.colored = true;
      toned.transfer = in_tone(view.transfer.points());
    } else {
      view.lenses[0].colored = true;
      toned.lenses[0].transfer = in_tone(lens.transfer->points());
    }
    const FloatImage by_voxels = picture.draw(view, camera_of(view));
    EXPECT_LE(worst_difference(by_voxels, picture.draw(toned, camera_of(toned))), 1.0 / 255.0);
    view.colored = view.lenses[0].colored = false;
    EXPECT_GT(worst_difference(by_voxels, picture.draw(view, camera_of(view))), 0.1) << "colours do nothing";
  }
}

// Along x the voxels go from black to red: half of it in the middle, whatever lies around.
TEST(LensPicture, ColoursAreThoseOfThePlace) {
  VolumeView view = with_colors(plain_view(), [](const Vec3& x) {
    return std::array<std::uint8_t, 4>{static_cast<std::uint8_t>(std::lround(127.5 * (1.0 + x.x))), 0, 0, 0};
  });
  view.transfer = ColorTransfer({{-10.0, Vec3f(1.0F), 0.9}});
  view.shading = false;
  view.colored = true;
  VolumePicture picture(kSize, kSize);
  const Camera camera = camera_of(view, {.azimuth = 0.0, .elevation = 0.0}, Projection::kOrthographic);
  const FloatImage image = picture.draw(view, camera);
  for (const int x : {20, 40, 60}) {
    const double place = (x + 0.5 - 0.5 * kSize) * camera.view_height / kSize;
    if (std::abs(place) > 0.95) continue;
    EXPECT_NEAR(image.at(x, kSize / 2)[0], 0.5 * (1.0 + place), 0.01) << x;
    EXPECT_EQ(image.at(x, kSize / 2)[1], 0.0);
  }
}

TEST(LensPicture, ColoursCostNothingWhereNoPartAsksForThem) {
  VolumePicture picture(16, 16);
  VolumeView view = with_colors(plain_view(), [](const Vec3&) { return std::array<std::uint8_t, 4>{}; });
  (void)picture.draw(view, camera_of(view));
  const std::uint64_t plain = picture.cost().voxel_bytes;
  const int programs = picture.cost().programs;
  view.colored = true;
  (void)picture.draw(view, camera_of(view));
  EXPECT_EQ(picture.cost().voxel_bytes, plain + 4 * view.image->point_count());
  EXPECT_EQ(picture.cost().programs, programs + 1);
}

}  // namespace
}  // namespace palpate::test
