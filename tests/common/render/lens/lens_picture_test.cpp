// Pictures of volumes with lenses, against the brute-force integrator and against pictures without.

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/render/lens/lens.h"
#include "common/render/volume/volume_picture.h"
#include "tests/common/render/lens/sample_lenses.h"
#include "tests/common/render/reference_agreement.h"
#include "tests/support/half_space.h"
#include "tests/support/reference_ray.h"

namespace palpate::test {
namespace {

constexpr int kSize = Agreement{}.size;
constexpr double kSamples = Agreement{}.samples;

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

// Every shape beside the volume, around all of it, and of next to no size, as rays see it that graze the
// faces of the volume.
TEST(LensPicture, AgreesWithTheReferenceForEveryShapeOfAnySizeAtGrazingViews) {
  constexpr Agreement kSmall{.size = 48};
  VolumePicture picture(kSmall.size, kSmall.size);
  for (const auto& [name, lens] : lenses()) {
    const bool sized = name != "half-space";
    const std::vector<std::pair<std::string, ConvexShape>> shapes{
        {"as it is", lens.shape},
        {"beside the volume", moved(lens.shape, {sized ? 4.0 : 40.0, 0.5, 0.0})},
        {"around it", sized ? scaled(lens.shape, 12.0) : moved(lens.shape, {-40.0, 0.0, 0.0})},
        {"of no size", sized ? scaled(lens.shape, 1e-12) : lens.shape}};
    for (const auto& [size, shape] : shapes) {
      VolumeView view = plain_view();
      view.lenses = {lens};
      view.lenses[0].shape = shape;
      expect_agreement(picture, view, camera_of(view, {.azimuth = 0.0, .elevation = 0.5}), name + " " + size,
                       kSmall);
    }
  }
}

TEST(LensPicture, AgreesWithTheReferenceOnTheScreen) {
  VolumePicture picture(kSize, kSize);
  VolumeView view = plain_view();
  Lens lens = lenses()[0].lens;
  lens.screen = ScreenCircle{.x = 0.1, .y = -0.05, .radius = 0.2};
  for (const bool bounded : {false, true}) {
    if (!bounded) lens.shape = {};
    if (bounded) lens.shape = make_half_space({0.1, 0.0, 0.0}, {1.0, 2.0, -0.5});
    lens.cut = bounded;
    view.lenses = {lens, lenses()[1].lens};
    for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic})
      expect_agreement(picture, view, camera_of(view, {}, projection),
                       bounded ? "half of a circle" : "a circle");
  }
  // It stays where it is when the volume is turned, and nothing changes outside it.
  view.lenses = {lens};
  view.lenses[0].shape = {};
  view.lenses[0].cut = true;
  const FloatImage cut = picture.draw(view, camera_of(view, {.azimuth = 110.0, .elevation = -20.0}));
  const FloatImage whole =
      picture.draw(plain_view(), camera_of(view, {.azimuth = 110.0, .elevation = -20.0}));
  int changed = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const bool inside = lens.screen->holds((x + 0.5) / kSize - 0.5, (y + 0.5) / kSize - 0.5);
      if (inside) {
        EXPECT_EQ(cut.at(x, y)[3], 0.0) << x << ' ' << y;
      } else {
        EXPECT_NEAR(cut.at(x, y)[3], whole.at(x, y)[3], 0.5 / 255.0) << x << ' ' << y;
      }
      changed += inside && whole.at(x, y)[3] > 0.1 ? 1 : 0;
    }
  }
  EXPECT_GT(changed, 500);
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

TEST(LensPicture, AgreesWithTheReferenceWherePlanesCut) {
  VolumePicture picture(kSize, kSize);
  VolumeView view = plain_view();
  const CuttingPlane oblique{.kept = {glm::normalize(Vec3(1.0, 2.0, -0.5)), 0.1}};
  const CuttingPlane along{.kept = {{0.0, 0.0, 1.0}, 0.3}};
  for (const bool lensed : {false, true}) {
    if (lensed) view.lenses = {lenses()[0].lens};
    for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
      const Camera camera = camera_of(view, {.azimuth = 0.0, .elevation = 0.0}, projection);
      view.cuts = {oblique, along};
      expect_agreement(picture, view, camera, lensed ? "two cuts and a lens" : "two cuts");
      view.cuts[0].on = false;
      expect_agreement(picture, view, camera, lensed ? "one cut and a lens" : "one cut");
    }
  }
  // Against the lens that cuts the same away.
  view.cuts = {oblique};
  const FloatImage cut = picture.draw(view, camera_of(view));
  Lens gone{make_half_space(0.1 * oblique.kept.outward, -oblique.kept.outward)};
  gone.cut = true;
  view.cuts.clear();
  view.lenses.insert(view.lenses.begin(), gone);
  EXPECT_LT(worst_difference(cut, picture.draw(view, camera_of(view))), 0.5 / 255.0);
}

// Many planes leave what one polyhedron of as many faces leaves: a ball, nearly.
TEST(LensPicture, AgreesWithTheReferenceWhereManyPlanesCut) {
  VolumePicture picture(kSize, kSize);
  VolumeView view = plain_view();
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < kMostCuts; ++i) {
    const Vec3 n = glm::normalize(Vec3(normal(random), normal(random), normal(random)));
    view.cuts.push_back({.kept = {n, 0.7}});
  }
  expect_agreement(picture, view, camera_of(view), "as many planes as there may be");
  const FloatImage many = picture.draw(view, camera_of(view));
  view.cuts.clear();
  EXPECT_GT(worst_difference(many, picture.draw(view, camera_of(view))), 0.1) << "they cut";
}

// Pictures while one plane moves, with what is kept of the one before and cast anew.
class MovingPlane : public testing::Test {
 protected:
  static constexpr int kSize = 48;

  // Draws `view` with its first cut at each offset, in turn. @return how many pictures were put together.
  int expect_same(VolumeView view, const Camera& camera, const std::vector<double>& offsets,
                  const std::string& what, const std::vector<std::vector<float>>& depths = {}) {
    int kept = 0;
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      const std::vector<float> depth = depths.empty() ? std::vector<float>() : depths[i % depths.size()];
      view.cuts[0].kept.offset = offsets[i];
      view.cache_slabs = true;
      const FloatImage moved = moving_.draw(view, camera, depth);
      kept += moving_.cost().slab_bytes > 0 ? 1 : 0;
      view.cache_slabs = false;
      const double off = worst_difference(moved, still_.draw(view, camera, depth));
      EXPECT_LE(off, 1.0 / 255.0) << what << ", at " << offsets[i];
      EXPECT_EQ(still_.cost().slab_bytes, 0U);
    }
    return kept;
  }

  // Up, down, by jumps and by less than a step, out of the volume on either side.
  std::vector<double> path(double reach) {
    std::vector<double> offsets{0.0,          0.01,        0.5 * reach, 0.5 * reach + 1e-4,
                                -0.4 * reach, 1.1 * reach, -1.1 * reach};
    std::uniform_real_distribution<double> anywhere(-reach, reach);
    for (int i = 0; i < 2; ++i) offsets.push_back(anywhere(random_));
    return offsets;
  }

  std::mt19937 random_{11};
  VolumePicture moving_{kSize, kSize}, still_{kSize, kSize};
};

TEST_F(MovingPlane, ChangesNoPixelOfAFullRedraw) {
  std::normal_distribution<double> normal;
  const auto any = [&] { return glm::normalize(Vec3(normal(random_), normal(random_), normal(random_))); };
  std::vector<std::pair<std::string, VolumeView>> views;
  views.emplace_back("plain", plain_view());
  views.emplace_back("shaded", plain_view()).second.shading = true;
  views.emplace_back("lens", plain_view()).second.lenses = {lenses()[0].lens, lenses()[3].lens};
  views.back().second.lenses[1].cut = true;
  views.emplace_back("magnified", plain_view()).second.lenses = {lenses()[1].lens};
  views.back().second.lenses[0].magnification = 2.5;
  views.emplace_back("coarse", plain_view()).second.samples_per_voxel = 0.5;
  views.emplace_back("dense", even_view(20.0));
  for (auto& [name, view] : views) {
    // Across the view, from either side, along it, along the data, anyhow.
    const CameraAngles angles{.azimuth = 25.0, .elevation = 35.0};
    const Mat3 axes = camera_of(view, angles).axes;
    Projection projection = Projection::kPerspective;
    for (const Vec3& n : {axes[2], -axes[2], axes[0], Vec3(0.0, 0.0, 1.0), any()}) {
      view.cuts = {{.kept = {n, 0.0}}};
      const std::vector<double> offsets = path(1.7);
      const int kept = expect_same(view, camera_of(view, angles, projection), offsets, name);
      EXPECT_EQ(kept, static_cast<int>(offsets.size()) - 1) << "all but the first";
      projection =
          projection == Projection::kPerspective ? Projection::kOrthographic : Projection::kPerspective;
    }
  }
}

// Made at rest, the pictures serve wherever the plane goes, and change nothing.
TEST_F(MovingPlane, FindsAllPicturesThatWereMadeBeforeItMoves) {
  VolumeView view = plain_view();
  EXPECT_FALSE(moving_.prepare_slabs(0)) << "nothing is drawn";
  const Camera camera = camera_of(view);
  std::vector<float> depth(static_cast<std::size_t>(kSize * kSize), 1.0F);
  for (std::size_t i = 0; i < depth.size(); i += 29) depth[i] = 0.6F;
  for (const Vec3& n : {glm::normalize(Vec3(1.0, 0.2, 0.4)), camera.axes[2], -camera.axes[2]}) {
    for (const double at : {0.2, -1.5, 1.5}) {
      view.cuts = {{.kept = {{0.0, 1.0, 0.0}, 0.6}}, {.kept = {n, at}}};
      view.cache_slabs = true;
      (void)moving_.draw(view, camera, depth);
      int more = 0;
      while (moving_.prepare_slabs(1) && more < 1000) ++more;
      EXPECT_EQ(more > 0, at == 0.2) << "those of the plane where it was before serve again";
      EXPECT_FALSE(moving_.prepare_slabs(1)) << "all are made";
      const std::uint64_t bytes = moving_.cost().slab_bytes;
      EXPECT_GT(bytes, 0U);
      for (const double offset : path(1.2)) {
        view.cuts[1].kept.offset = offset;
        view.cache_slabs = true;
        const FloatImage moved = moving_.draw(view, camera, depth);
        EXPECT_EQ(moving_.cost().slab_bytes, bytes) << offset;
        view.cache_slabs = false;
        EXPECT_LE(worst_difference(moved, still_.draw(view, camera, depth)), 1.0 / 255.0) << offset;
      }
    }
  }
  // Only for cuts that are there, and only where they may be kept.
  view.cache_slabs = false;
  (void)moving_.draw(view, camera);
  EXPECT_FALSE(moving_.prepare_slabs(1));
  view.cache_slabs = true;
  view.cuts[1].on = false;
  (void)moving_.draw(view, camera);
  EXPECT_FALSE(moving_.prepare_slabs(1));
  EXPECT_FALSE(moving_.prepare_slabs(2));
  EXPECT_TRUE(moving_.prepare_slabs(0));
}

// A second plane stands still, opaque things move; and whatever else changes, nothing is left of the old.
TEST_F(MovingPlane, MayHaveOthersAboutIt) {
  VolumeView view = plain_view();
  view.lenses = {lenses()[2].lens};
  const Camera camera = camera_of(view);
  view.cuts = {{.kept = {glm::normalize(Vec3(1.0, 0.2, 0.4)), 0.0}}, {.kept = {{0.0, 1.0, 0.0}, 0.3}}};
  std::vector<std::vector<float>> depths(3,
                                         std::vector<float>(static_cast<std::size_t>(kSize * kSize), 1.0F));
  std::uniform_real_distribution<float> near(0.3F, 0.9F);
  for (std::vector<float>& depth : depths) {
    for (std::size_t i = 0; i < depth.size(); i += 37 + 5 * (random_() % 3)) depth[i] = near(random_);
  }
  EXPECT_GT(expect_same(view, camera, path(1.2), "opaque things", depths), 5);

  EXPECT_GT(expect_same(view, camera, {0.1, 0.2}, "none of them"), 0)
      << "from the first picture without them on";
  const auto forgets = [&](const char* what, VolumeView other, const Camera& from) {
    view.cuts[0].kept.offset += 0.01;
    (void)moving_.draw(view, camera);
    view.cuts[0].kept.offset += 0.01;
    (void)moving_.draw(view, camera);
    EXPECT_GT(moving_.cost().slab_bytes, 0U) << what;
    other.cuts[0].kept.offset = 0.2;
    const FloatImage now = moving_.draw(other, from);
    EXPECT_EQ(moving_.cost().slab_bytes, 0U) << what;
    other.cache_slabs = false;
    EXPECT_EQ(worst_difference(now, still_.draw(other, from)), 0.0) << what;
  };
  VolumeView other = view;
  other.shading = true;
  forgets("light", other, camera);
  other = view;
  other.cuts[1].kept.offset = 0.2;
  forgets("two planes at once", other, camera);
  other = view;
  other.transfer = focus_colors();
  forgets("colours", other, camera);
  other = view;
  other.cuts[0].kept.outward = {0.0, 0.0, 1.0};
  forgets("a turned plane", other, camera);
  forgets("the camera", view, camera_of(view, {.azimuth = 70.0}));
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

// Shapes of all kinds all over the volume, half of them cut away, in eight transfer functions.
std::vector<Lens> many_lenses(std::size_t count, double size) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-0.9, 0.9), share(0.5, 1.0);
  std::normal_distribution<double> normal;
  const auto anywhere = [&] { return Vec3(place(random), place(random), place(random)); };
  std::vector<Lens> lenses;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 middle = anywhere();
    const double radius = size * share(random);
    std::vector<ConvexShape::HalfSpace> faces;
    while (i % 4 == 3 && faces.size() < 12) {
      const Vec3 n = glm::normalize(Vec3(normal(random), normal(random), normal(random)));
      faces.push_back({n, glm::dot(n, middle) + radius});
    }
    const Vec3 half = radius * glm::normalize(Vec3(normal(random), normal(random), normal(random)));
    Lens lens{i % 4 == 0   ? make_sphere(middle, radius)
              : i % 4 == 1 ? make_box(middle, radius * Mat3(1.0))
              : i % 4 == 2 ? make_cylinder(middle - half, middle + half, 0.7 * radius)
                           : make_polyhedron(faces)};
    const float tone = static_cast<float>(i % 8) / 8.0F;
    lens.transfer = ColorTransfer({{0.0, Vec3f(tone, 0.5F, 1.0F - tone), 0.03}});
    lens.shading = false;
    lens.cut = i / 4 % 2 == 1;
    lenses.push_back(lens);
  }
  return lenses;
}

// What few lenses are looked up in, what more of them are, and what a uniform block does not hold.
TEST(LensPicture, AgreesWithTheReferenceForManyShapes) {
  VolumePicture picture(kSize, kSize);
  for (const std::size_t count : {8U, 9U, 16U, 17U, 70U}) {
    VolumeView view = plain_view();
    view.lenses = many_lenses(count, 0.25);
    expect_agreement(picture, view, camera_of(view), std::to_string(count) + " lenses");
    // The context by itself, in pixels that are hardly larger: others at borders of lenses alone.
    const FloatImage whole = picture.draw(view, camera_of(view));
    view.context.viewport = 0.999;
    const FloatImage parted = picture.draw(view, camera_of(view));
    int off = 0;
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        off += std::abs(whole.at(x, y)[3] - parted.at(x, y)[3]) > 0.02 ? 1 : 0;
      }
    }
    EXPECT_LE(off, kSize * kSize / 20) << count << " lenses";
  }
}

TEST(LensPicture, HoldsAsManyLensesAsThereMayBe) {
  constexpr int kSmall = 24;
  VolumePicture picture(kSmall, kSmall);
  VolumeView view = plain_view();
  view.lenses = many_lenses(kMostLenses, 0.08);
  const Comparison result = compare(picture.draw(view, camera_of(view)),
                                    ReferenceRay(view, camera_of(view), kSmall, kSmall, kSamples), kBound);
  EXPECT_LE(result.worst, kBound) << result.beyond_bound << " pixels";
  EXPECT_LE(result.exempt, kSmall * kSmall / 50);
  EXPECT_GT(
      worst_difference(picture.draw(view, camera_of(view)), picture.draw(plain_view(), camera_of(view))),
      0.1);
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
