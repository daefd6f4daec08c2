#include "common/render/volume/volume_pass.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "common/math/power_of_two.h"
#include "common/render/volume/volume_picture.h"
#include "tests/common/render/volume/sample_volumes.h"
#include "tests/support/reference_ray.h"

namespace palpate::test {
namespace {

constexpr int kSize = 96;
constexpr double kSamples = 50.0;  // a voxel, of a reference ray: thousands along it
constexpr double kBound = 2.0 / 255.0;

Camera camera_of(const VolumeView& view, const CameraAngles& angles = {},
                 Projection projection = Projection::kPerspective) {
  return make_camera(view.image->bounds(), angles, 1.0, projection);
}

// The picture of `view` against the reference; few pixels may be too uncertain to count.
void expect_agreement(const VolumeView& view, const Camera& camera, const char* what) {
  VolumePicture picture(kSize, kSize);
  const Comparison result =
      compare(picture.draw(view, camera), ReferenceRay(view, camera, kSize, kSize, kSamples), kBound);
  EXPECT_LE(result.worst, kBound) << what << ": " << result.beyond_bound << " pixels";
  EXPECT_LE(result.exempt, kSize * kSize / 500) << what;
}

// Opacity of the whole picture, to tell that there is something in it.
double mean_opacity(const FloatImage& image) {
  double sum = 0.0;
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) sum += static_cast<double>(image.rgba[i]);
  return 4.0 * sum / static_cast<double>(image.rgba.size());
}

TEST(VolumePass, AgreesWithTheReferenceForEveryTypeOfVoxels) {
  for (const ScalarType type : {ScalarType::kUint8, ScalarType::kUint16, ScalarType::kFloat32}) {
    const VolumeView view = sampled_view(blobs, type);
    EXPECT_EQ(view.image->type, type);
    expect_agreement(view, camera_of(view), name_of(type));
  }
}

TEST(VolumePass, AgreesWithTheReferenceOnShellsAndFineContrast) {
  const VolumeView round = sampled_view(shells);
  expect_agreement(round, camera_of(round), "shells");
  // 41 points hold no more contrast than this: its values bend so much within a voxel that it takes more
  // samples.
  VolumeView fine = sampled_view(marschner_lobb, ScalarType::kFloat32, 41);
  fine.samples_per_voxel = 6.0;
  expect_agreement(fine, camera_of(fine), "Marschner-Lobb");
}

TEST(VolumePass, AgreesWithTheReferenceUnderLight) {
  VolumeView view = sampled_view(blobs);
  view.shading = true;
  expect_agreement(view, camera_of(view), "shaded");
}

TEST(VolumePass, AgreesWithTheReferenceInOrthographicAndGrazingViews) {
  const VolumeView view = sampled_view(blobs);
  expect_agreement(view, camera_of(view, {}, Projection::kOrthographic), "orthographic");
  // Along the axes, where rays lie in the faces of cells and of the volume.
  expect_agreement(view, camera_of(view, {.azimuth = 0.0, .elevation = 0.0}, Projection::kOrthographic),
                   "along an axis");
  expect_agreement(view, camera_of(view, {.azimuth = 0.0, .elevation = 0.5}), "grazing");
  expect_agreement(view, camera_of(view, {.azimuth = 45.0, .elevation = 89.9}), "from above");
}

// The eyes of a head before a screen: tiles without anything in them are found off the axis, too.
TEST(VolumePass, AgreesWithTheReferenceOffAxis) {
  VolumeView view = sampled_view(blobs, ScalarType::kFloat32, 65);
  view.transfer = spread(ColorTransfer({{0.8, Vec3f(0.0F), 0.0}, {1.0, Vec3f(1.0F), 0.5}}), 0.0, 1.0);
  for (const bool skip : {false, true}) {
    view.skip_empty = skip;
    Camera camera = camera_of(view);
    camera.eye_offset = camera.view_height * Vec2(0.9, -0.6);
    expect_agreement(view, camera, skip ? "off-axis, without empty bricks" : "off-axis");
  }
}

TEST(VolumePass, AgreesWithTheReferenceFromInside) {
  const VolumeView view = sampled_view(blobs);
  Camera camera = camera_of(view);
  camera.focal_point = Vec3(0.3, 0.1, -0.2);
  camera.view_height = 0.3;
  ASSERT_TRUE(view.image->bounds().upper.x > std::abs(eye(camera).x));
  expect_agreement(view, camera, "inside");
}

TEST(VolumePass, FindsTheOpacityOfEvenMatterFromItsThickness) {
  const VolumeView view = even_view(0.7);
  const Camera camera = camera_of(view, {.azimuth = 0.0, .elevation = 0.0}, Projection::kOrthographic);
  VolumePicture picture(32, 32);
  const Rgba middle = picture.draw(view, camera).at(16, 16);
  const double opacity = 1.0 - std::exp(-2.0 * 0.7);
  EXPECT_NEAR(middle[3], opacity, 1e-3);
  EXPECT_NEAR(middle[0], 0.2 * opacity, 1e-3);
  EXPECT_NEAR(middle[2], opacity, 1e-3);
}

TEST(VolumePass, DoesNotChangeOpacityWithTheNumberOfSamples) {
  VolumeView view = even_view(0.7);
  const Camera camera = camera_of(view);
  VolumePicture picture(32, 32);
  const FloatImage usual = picture.draw(view, camera);
  for (const double samples : {0.37, 1.0, 9.0}) {
    view.samples_per_voxel = samples;
    EXPECT_LT(worst_difference(picture.draw(view, camera), usual), 2e-3) << samples;
  }
}

TEST(VolumePass, LeapsOverEmptyBricksWithoutATrace) {
  VolumeView view = sampled_view(blobs, ScalarType::kFloat32, 65);
  view.transfer = spread(ColorTransfer({{0.8, Vec3f(0.0F), 0.0}, {1.0, Vec3f(1.0F), 0.5}}), 0.0, 1.0);
  VolumePicture picture(kSize, kSize);
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    for (const double azimuth : {0.0, 30.0, 50.0}) {
      // The last one from within the volume, where bricks lie beside the eye.
      const Camera camera = camera_of(
          view, {.azimuth = azimuth, .elevation = azimuth, .zoom = azimuth == 50.0 ? 5.0 : 1.0}, projection);
      view.skip_empty = true;
      const FloatImage leaping = picture.draw(view, camera);
      EXPECT_GT(picture.cost().empty_share, 0.5);
      EXPECT_GT(mean_opacity(leaping), 0.005);
      view.skip_empty = false;
      EXPECT_LT(worst_difference(picture.draw(view, camera), leaping), 0.5 / 255.0);
    }
  }
}

TEST(VolumePass, EndsOpaqueRaysWithinHalfALevel) {
  VolumeView view = sampled_view(blobs);
  view.opacity_length *= 0.01;
  const Camera camera = camera_of(view);
  VolumePicture picture(kSize, kSize);
  const FloatImage ended = picture.draw(view, camera);
  view.stop_where_opaque = false;
  EXPECT_LE(worst_difference(picture.draw(view, camera), ended), 0.51 / 255.0);
}

TEST(VolumePass, EndsAtOpaqueThingsRightToThePixel) {
  const VolumeView view = even_view(0.7);
  for (const Projection projection : {Projection::kOrthographic, Projection::kPerspective}) {
    const Camera camera = camera_of(view, {.azimuth = 0.0, .elevation = 0.0}, projection);
    // The depth of the plane y = 0.2, which stands at right angles to the view from -y.
    const ViewTransform transform = view_transform(camera, frame_of(view), view.image->bounds(), 1.0);
    const Vec4 clip =
        transform.clip_from_scene * Vec4(frame_of(view).scene_from_data(Vec3(0.0, 0.2, 0.0)), 1.0);
    const auto depth = static_cast<float>(0.5 + 0.5 * clip.z / clip.w);
    std::vector<float> depths(32 * 32, 1.0F);
    for (std::size_t y = 0; y < 32; ++y) {
      for (std::size_t x = 16; x < 32; ++x) depths[32 * y + x] = depth;
    }
    VolumePicture picture(32, 32);
    const FloatImage image = picture.draw(view, camera, depths);
    EXPECT_NEAR(image.at(15, 16)[3], 1.0 - std::exp(-2.0 * 0.7), 3e-4);
    EXPECT_NEAR(image.at(16, 16)[3], 1.0 - std::exp(-1.2 * 0.7), 3e-4);
  }
}

// Longer along one axis by a thousand: rays along it and across it keep to the reference.
TEST(VolumePass, DrawsVoxelsAThousandTimesAsLongAsWide) {
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 spacing(0.001);
    Index3 points(33);
    spacing[axis] = 1.0;
    points[axis] = 17;
    const VolumeView view = view_of(sampled_block(points, spacing, ScalarType::kFloat32, blobs));
    Camera camera = camera_of(view, {.azimuth = 20.0, .elevation = 10.0});
    expect_agreement(view, camera, "all of it");
    camera.view_height = 0.06;  // the thin side fills the picture
    expect_agreement(view, camera, "close by");
  }
}

TEST(VolumePass, DrawsASheetOfOneVoxelAsThickAsItsSpacing) {
  VolumeView view =
      view_of(sampled_block({9, 1, 9}, Vec3(0.25), ScalarType::kUint8, [](const Vec3&) { return 1.0; }));
  view.transfer = ColorTransfer({{0.0, Vec3f(1.0F), 0.5}});
  view.opacity_length = 0.25;
  VolumePicture picture(32, 32);
  const Camera camera = camera_of(view, {.azimuth = 0.0, .elevation = 0.0}, Projection::kOrthographic);
  EXPECT_NEAR(picture.draw(view, camera).at(16, 16)[3], 0.5, 2e-3);
  VolumeView pattern = view_of(sampled_block({33, 33, 1}, Vec3(0.06), ScalarType::kFloat32, blobs));
  expect_agreement(pattern, camera_of(pattern), "a pattern on a sheet");
}

TEST(VolumePass, ShowsNothingInCellsWithNan) {
  VolumeView view = even_view(0.7);
  DataSet block = sampled_block(Index3(9), Vec3(0.25), ScalarType::kFloat32, [](const Vec3& x) {
    return x.x > 0.1 ? std::numeric_limits<double>::quiet_NaN() : 0.5;
  });
  view.image = make_volume_image(block, "s", "test");
  const Camera camera = camera_of(view, {.azimuth = 0.0, .elevation = 0.0}, Projection::kOrthographic);
  for (const bool shading : {false, true}) {
    view.shading = shading;
    VolumePicture picture(64, 64);
    const FloatImage image = picture.draw(view, camera);
    for (const float part : image.rgba) ASSERT_TRUE(std::isfinite(part));
    EXPECT_NEAR(image.at(24, 32)[3], 1.0 - std::exp(-1.4), 2e-3);
    EXPECT_EQ(image.at(45, 32)[3], 0.0);
  }
}

TEST(VolumePass, ShowsNothingOfAVolumeWithoutValues) {
  VolumeView view = even_view(0.7);
  view.image = make_volume_image(
      sampled_block(Index3(5), Vec3(0.5), ScalarType::kFloat32, [](const Vec3&) { return std::nan(""); }),
      "s", "test");
  VolumePicture picture(16, 16);
  EXPECT_EQ(mean_opacity(picture.draw(view, camera_of(view))), 0.0);
  EXPECT_EQ(picture.cost().empty_share, 1.0);
}

// Turned and sheared axes, one of them left-handed.
TEST(VolumePass, FollowsAxesThatAreNotThoseOfTheData) {
  DataSet block = sampled_block(Index3(25), Vec3(0.08), ScalarType::kFloat32, blobs);
  auto& grid = std::get<UniformTopology>(block.topology);
  grid.axes = 0.08 * Mat3(Vec3(0.8, 0.6, 0.0), Vec3(0.55, -0.8, 0.1), Vec3(0.2, 0.1, 0.9));
  grid.origin = Vec3(5.0, -3.0, 2.0);
  VolumeView view = view_of(block);
  view.shading = true;
  expect_agreement(view, camera_of(view), "sheared");
}

TEST(VolumePass, DrawsTheSameBitsAtAnyPowerOfTwo) {
  const VolumeView view = sampled_view(blobs);
  VolumePicture picture(kSize, kSize);
  const FloatImage usual = picture.draw(view, camera_of(view));
  for (const int exponent : {-90, 3, 90}) {
    const double unit = power_of_two(exponent);
    DataSet block = sampled_block(
        Index3(33), Vec3(unit * 2.0 / 32), ScalarType::kFloat32,
        [&](const Vec3& x) { return unit * static_cast<double>(static_cast<float>(blobs(x))); });
    const VolumeView scaled = view_of(block);
    EXPECT_EQ(worst_difference(picture.draw(scaled, camera_of(scaled)), usual), 0.0) << exponent;
  }
}

// A compute shader makes the same tables, so the pictures are the same bits; while one transfer function is
// dragged, only its table is made anew, and the picture is that of all made at once.
TEST(VolumePass, TablesOfAComputeShaderAndThoseOfOneFunctionAlone) {
  VolumeView view = sampled_view(blobs, ScalarType::kUint8);
  view.table_entries = 64;
  view.lenses = {{.shape = make_sphere(Vec3(0.0), 0.5)}};
  const auto fitted = [&](const ColorTransfer& transfer) {
    return spread(transfer, view.image->lowest, view.image->highest);
  };
  view.lenses[0].transfer =
      fitted(ColorTransfer({{0.1, Vec3f(1.0F), 0.0}, {0.8, Vec3f(1.0F, 0.0F, 0.2F), 0.3}}));
  const Camera camera = camera_of(view);
  VolumePicture picture(kSize, kSize);
  (void)picture.draw(view, camera);
  EXPECT_EQ(picture.cost().tables_made, 2);
  const std::string faster = picture.cost().tables_by;
  EXPECT_TRUE(faster.starts_with("processor") || faster.starts_with("GPU")) << faster;
  for (const TableMaker maker : {TableMaker::kProcessor, TableMaker::kGpu}) {
    view.table_maker = maker;
    view.lenses[0].transfer = fitted(ColorTransfer(
        {{0.1, Vec3f(1.0F), 0.0}, {0.8, Vec3f(0.0F, 0.5F, 0.2F), maker == TableMaker::kGpu ? 0.5 : 0.2}}));
    const FloatImage dragged = picture.draw(view, camera);
    EXPECT_EQ(picture.cost().tables_made, 1);
    EXPECT_EQ(picture.cost().programs, 2) << "rays and tiles";
    view.table_maker = TableMaker::kProcessor;
    VolumePicture fresh(kSize, kSize, VolumePicture::Context::kCurrent);
    EXPECT_EQ(worst_difference(dragged, fresh.draw(view, camera)), 0.0);
  }
  EXPECT_EQ(picture.cost().tables_by, "GPU, as asked for");
}

// As in an editor: one point of five is moved, step by step, and back.
TEST(VolumePass, MakesOfATableWhatADraggedPointChanges) {
  VolumeView view = sampled_view(blobs, ScalarType::kUint8);
  view.table_entries = 64;
  view.samples_per_voxel = 0.5;  // values far apart meet in a segment
  const Camera camera = camera_of(view);
  VolumePicture picture(kSize, kSize);
  for (const TableMaker maker : {TableMaker::kProcessor, TableMaker::kGpu}) {
    view.table_maker = maker;
    for (const double moved : {0.25, 0.3, 0.35, 0.2}) {
      view.transfer = spread(ColorTransfer({{0.0, Vec3f(0.2F, 0.4F, 1.0F), 0.0},
                                            {0.1, Vec3f(1.0F, 0.3F, 0.1F), 0.02},
                                            {moved, Vec3f(0.1F, 1.0F, 0.2F), moved},
                                            {0.5, Vec3f(1.0F), 0.05},
                                            {1.0, Vec3f(1.0F, 0.0F, 0.2F), 0.3}}),
                             view.image->lowest, view.image->highest);
      const FloatImage dragged = picture.draw(view, camera);
      if (moved > 0.25) {
        EXPECT_NEAR(picture.cost().segments_made, 1.0 - 0.01 - 0.25, 0.05);
      }
      VolumePicture fresh(kSize, kSize, VolumePicture::Context::kCurrent);
      EXPECT_EQ(worst_difference(dragged, fresh.draw(view, camera)), 0.0) << moved;
      EXPECT_EQ(fresh.cost().segments_made, 1.0);
    }
  }
}

TEST(VolumePass, CompilesOnlyTheShadersThatItNeeds) {
  VolumeView view = sampled_view(blobs, ScalarType::kUint8);
  VolumePicture picture(16, 16);
  (void)picture.draw(view, camera_of(view));
  (void)picture.draw(view, camera_of(view));
  EXPECT_EQ(picture.cost().programs, 2);  // rays without light, and tiles
  view.shading = true;
  (void)picture.draw(view, camera_of(view));
  EXPECT_EQ(picture.cost().programs, 3);
  EXPECT_EQ(picture.cost().voxel_bytes, 33U * 33U * 33U);
  EXPECT_EQ(picture.cost().table_bytes, 8U * 256U * 256U * 32U);
}

}  // namespace
}  // namespace palpate::test
