// Pixels of slices against closed forms: linear values on lattices that are turned, sheared and stretched, of every type
// of number, seen from any side.

#include "common/render/slice/slice_raster.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/math/quaternion.h"

namespace palpate {
namespace {

using Random = std::mt19937;

Vec3 any_vector(Random& random) {
  std::normal_distribution<double> normal;
  return {normal(random), normal(random), normal(random)};
}

Mat3 any_turn(Random& random) {
  const Vec3 v = any_vector(random);
  std::normal_distribution<double> normal;
  return glm::mat3_cast(glm::normalize(Quat(normal(random), v.x, v.y, v.z)));
}

/// value = at_origin + slope . (x - origin) at each point.
struct LinearImage {
  VolumeImage image;
  Vec3 slope{0.0};
  double at_origin = 0.0;

  [[nodiscard]] double exact(const Vec3& x) const { return at_origin + glm::dot(slope, x - image.origin); }
};

/// Values that numbers of the type hold exactly: whole numbers times `scale`.
template <typename T>
LinearImage linear_image(Random& random, ScalarType type) {
  LinearImage made;
  VolumeImage& image = made.image;
  image.points = {9, 7, 6};
  image.origin = any_vector(random);
  std::uniform_real_distribution<double> length{0.3, 3.0}, shear{-0.4, 0.4};
  image.axes = any_turn(random) * Mat3{length(random), 0.0, 0.0,           shear(random),
                                       length(random), 0.0, shear(random), shear(random),
                                       length(random)};
  image.type = image.stored = type;
  image.scale = 0.25;
  image.offset = -3.0;
  const Index3 rise{2, 3, 5};
  auto numbers = std::make_shared<std::vector<T>>();
  for (int k = 0; k < image.points.z; ++k)
    for (int j = 0; j < image.points.y; ++j)
      for (int i = 0; i < image.points.x; ++i)
        numbers->push_back(static_cast<T>(20 + rise.x * i + rise.y * j + rise.z * k));
  image.bytes = std::as_bytes(std::span<const T>(*numbers));
  image.owner = numbers;
  made.at_origin = image.offset + image.scale * 20.0;
  image.lowest = made.at_origin;
  image.highest = made.at_origin + image.scale * (2.0 * 8 + 3.0 * 6 + 5.0 * 5);
  // slope . axes_a = scale * rise_a.
  made.slope = glm::inverse(glm::transpose(image.axes)) * (image.scale * Vec3(rise));
  return made;
}

Camera any_camera(Random& random, const VolumeImage& image) {
  Camera camera;
  camera.projection = Projection::kOrthographic;
  camera.axes = any_turn(random);
  std::uniform_real_distribution<double> part{0.3, 0.7};
  camera.focal_point =
      image.origin + image.axes * (Vec3(part(random), part(random), part(random)) * Vec3(image.points - 1));
  camera.view_height = image.bounds().diagonal();
  return camera;
}

Vec3 pixel_middle(const Camera& camera, int x, int y, int width, int height) {
  const double pixel = camera.view_height / height;
  return camera.focal_point + (x + 0.5 - 0.5 * width) * pixel * camera.axes[0] -
         (y + 0.5 - 0.5 * height) * pixel * camera.axes[1];
}

/// How far grid coordinates are from the border, inside positive [steps].
double depth_inside(const VolumeImage& image, const Vec3& x) {
  const Vec3 g = glm::inverse(image.axes) * (x - image.origin);
  double least = HUGE_VAL;
  for (int a = 0; a < 3; ++a) least = std::min({least, g[a], image.points[a] - 1 - g[a]});
  return least;
}

SliceView slice_of(const LinearImage& made) {
  SliceView slice;
  slice.image = std::make_shared<const VolumeImage>(made.image);
  slice.window = {made.image.highest - made.image.lowest, 0.5 * (made.image.highest + made.image.lowest)};
  return slice;
}

double grey_of(const SliceView& slice, double value) {
  return 255.0 * std::clamp((value - slice.window.level) / slice.window.width + 0.5, 0.0, 1.0);
}

void check_linear(const LinearImage& made, const Camera& camera, const SliceView& slice, double shift,
                  double tolerance) {
  constexpr int kWidth = 61, kHeight = 47;
  const Image picture = slice_raster(slice, camera, kWidth, kHeight);
  int seen = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const Vec3 place = pixel_middle(camera, x, y, kWidth, kHeight);
      const auto pixel = picture.pixel(x, y);
      double nearest = depth_inside(made.image, place), farthest = nearest;
      for (const double side : {-0.5, 0.5}) {
        const double there = depth_inside(made.image, place + side * slice.slab * camera.axes[2]);
        nearest = std::min(nearest, there);
        farthest = std::max(farthest, there);
      }
      if (slice.slab == 0.0 && nearest < -1e-6) {
        EXPECT_EQ(pixel[3], 0) << "outside";
      }
      if (nearest < 1e-6) continue;
      ++seen;
      ASSERT_EQ(pixel[3], 255);
      ASSERT_NEAR(pixel[0], grey_of(slice, made.exact(place) + shift), 0.51 + tolerance);
      ASSERT_EQ(pixel[0], pixel[1]);
      ASSERT_EQ(pixel[0], pixel[2]);
    }
  }
  if (slice.slab == 0.0) {
    EXPECT_GT(seen, 50);
  }
}

TEST(SliceRaster, ShowsLinearValuesFromAnySide) {
  Random random{5};
  for (int run = 0; run < 60; ++run) {
    const LinearImage made = run % 3 == 0   ? linear_image<std::uint8_t>(random, ScalarType::kUint8)
                             : run % 3 == 1 ? linear_image<std::uint16_t>(random, ScalarType::kUint16)
                                            : linear_image<float>(random, ScalarType::kFloat32);
    check_linear(made, any_camera(random, made.image), slice_of(made), 0.0, 1e-6);
  }
}

/// Through a slab a linear value has the plane's as its mean, and its ends differ by slope x thickness / 2, but for the
/// half of a plane's distance that the outermost planes lie within.
TEST(SliceRaster, SlabsAreMeansAndExtremes) {
  Random random{6};
  for (int run = 0; run < 30; ++run) {
    const LinearImage made = linear_image<float>(random, ScalarType::kFloat32);
    const Camera camera = any_camera(random, made.image);
    SliceView slice = slice_of(made);
    slice.slab = 1.5 * made.image.step_along(camera.axes[2]);
    const double rise = std::abs(glm::dot(made.slope, camera.axes[2])) * slice.slab;
    constexpr int planes = 3;  // two a step
    check_linear(made, camera, slice, 0.0, 1e-4);
    slice.rule = SlabRule::kHighest;
    check_linear(made, camera, slice, 0.5 * rise * (planes - 1) / planes, 1e-4);
    slice.rule = SlabRule::kLowest;
    check_linear(made, camera, slice, -0.5 * rise * (planes - 1) / planes, 1e-4);
  }
}

/// A voxel without a value clears what it counts for, and nothing on the plane of its neighbours.
TEST(SliceRaster, MissingValuesAreClear) {
  Random random{7};
  LinearImage made = linear_image<float>(random, ScalarType::kFloat32);
  made.image.axes = Mat3{1.0};
  made.image.origin = Vec3{0.0};
  std::vector<float> numbers(made.image.point_count(), 1.0F);
  numbers[4 + 9 * (3 + 7 * 2)] = std::numeric_limits<float>::quiet_NaN();
  made.image.bytes = std::as_bytes(std::span<const float>(numbers));
  const SliceView slice = slice_of(made);
  Camera camera;
  camera.projection = Projection::kOrthographic;
  camera.view_height = 7.0;
  for (const double z : {2.0, 2.5, 3.0}) {
    camera.focal_point = {4.0, 3.0, z};
    const Image picture = slice_raster(slice, camera, 9, 7);  // pixels on the points
    for (int y = 0; y < 7; ++y)
      for (int x = 0; x < 9; ++x)
        EXPECT_EQ(picture.pixel(x, y)[3], x == 4 && y == 3 && z < 3.0 ? 0 : 255) << x << " " << y << " " << z;
  }
  // A slab takes what there is.
  SliceView slab = slice;
  slab.slab = 3.0;
  camera.focal_point = {4.0, 3.0, 2.5};
  EXPECT_EQ(slice_raster(slab, camera, 9, 7).pixel(4, 3)[3], 255);
}

TEST(SliceRaster, AnImageOfOneLayerIsOneStepThick) {
  LinearImage made;
  made.image.points = {4, 3, 1};
  const std::vector<float> numbers(12, 5.0F);
  made.image.bytes = std::as_bytes(std::span<const float>(numbers));
  made.image.lowest = 0.0;
  made.image.highest = 10.0;
  const SliceView slice = slice_of(made);
  Camera camera;
  camera.projection = Projection::kOrthographic;
  camera.view_height = 4.0;
  for (const double z : {-0.51, -0.49, 0.0, 0.49, 0.51}) {
    camera.focal_point = {1.5, 1.0, z};
    const auto pixel = slice_raster(slice, camera, 5, 5).pixel(2, 2);
    EXPECT_EQ(pixel[3], std::abs(z) < 0.5 ? 255 : 0) << z;
    if (pixel[3] > 0) {
      EXPECT_EQ(pixel[0], 128) << z;
    }
  }
}

TEST(SliceRaster, ThreadsAndScaleChangeNoPixel) {
  Random random{8};
  const LinearImage made = linear_image<float>(random, ScalarType::kFloat32);
  const Camera camera = any_camera(random, made.image);
  const SliceView slice = slice_of(made);
  const Image one = slice_raster(slice, camera, 50, 40, 1);
  EXPECT_EQ(one.rgba, slice_raster(slice, camera, 50, 40, 2).rgba);
  for (const int exponent : {-400, 300}) {
    LinearImage scaled = made;
    Camera far = camera;
    const double factor = std::ldexp(1.0, exponent);
    scaled.image.axes *= factor;
    scaled.image.origin *= factor;
    far.focal_point *= factor;
    far.view_height *= factor;
    EXPECT_EQ(one.rgba, slice_raster(slice_of(scaled), far, 50, 40).rgba) << exponent;
  }
}

/// The second image is laid over the first where it has values, the clearer the lower they are.
TEST(SliceRaster, BlendsASecondImage) {
  Random random{9};
  const LinearImage made = linear_image<float>(random, ScalarType::kFloat32);
  const Camera camera = any_camera(random, made.image);
  SliceView slice = slice_of(made);
  const Image grey = slice_raster(slice, camera, 40, 30);
  for (const double opacity : {0.0, 0.5, 1.0}) {
    slice.blend = SliceBlend{.image = slice.image, .name = "", .window = slice.window, .opacity = opacity};
    const Image both = slice_raster(slice, camera, 40, 30);
    for (int y = 0; y < 30; ++y) {
      for (int x = 0; x < 40; ++x) {
        const auto a = grey.pixel(x, y), b = both.pixel(x, y);
        ASSERT_EQ(a[3], b[3]);
        if (a[3] == 0) continue;
        const double part = a[0] / 255.0, over = opacity * part;
        const Rgb color = map_color(ColorMap::kHeat, part);
        ASSERT_NEAR(b[0], 255.0 * (over * static_cast<double>(color.r) + (1.0 - over) * part), 3.0);
        ASSERT_NEAR(b[2], 255.0 * (over * static_cast<double>(color.b) + (1.0 - over) * part), 3.0);
      }
    }
  }
}

// A label is that of the nearest voxel, whatever number lies between two of them, and has its own colour.
TEST(SliceRaster, LabelsAreNotMixed) {
  VolumeImage image;
  image.points = {2, 1, 1};
  image.type = image.stored = ScalarType::kUint8;
  auto numbers = std::make_shared<std::vector<std::uint8_t>>(std::vector<std::uint8_t>{2, 9});
  image.bytes = std::as_bytes(std::span<const std::uint8_t>(*numbers));
  image.owner = numbers;
  image.lowest = 2.0;
  image.highest = 9.0;
  image.labels = std::make_shared<const LabelTable>(std::vector<Label>{
      {2.0, "a", {1.0F, 0.0F, 0.0F}}, {5.0, "between", {0.0F, 1.0F, 0.0F}}, {9.0, "b", {0.0F, 0.0F, 1.0F}}});
  SliceView slice{
      .image = std::make_shared<const VolumeImage>(image), .window = {1.0, 0.5}, .blend = {}, .traces = {}};
  Camera camera;
  camera.focal_point = {0.5, 0.0, 0.0};
  camera.axes = Mat3(1.0);
  camera.view_height = 1.0;
  constexpr int kWidth = 16, kHeight = 16;
  const Image picture = slice_raster(slice, camera, kWidth, kHeight, 1);
  for (int x = 0; x < kWidth; ++x) {
    const std::uint8_t* const pixel = picture.rgba.data() + 4 * (kWidth * (kHeight / 2) + x);
    EXPECT_EQ(pixel[0], x < kWidth / 2 ? 255 : 0) << x;
    EXPECT_EQ(pixel[1], 0) << x;
    EXPECT_EQ(pixel[2], x < kWidth / 2 ? 0 : 255) << x;
  }
}

}  // namespace
}  // namespace palpate
