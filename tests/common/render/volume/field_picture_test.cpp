// Lenses that show another scalar than what lies around them, on a grid of its own, against the brute-force
// integrator.

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/render/volume/volume_picture.h"
#include "common/render/volume/voxels/value_gradient.h"
#include "tests/common/render/lens/sample_lenses.h"
#include "tests/common/render/reference_agreement.h"

namespace palpate::test {
namespace {

constexpr Agreement kBar{.exempt = 250};
constexpr int kSize = Agreement{}.size;

// Turned about z, of other spacings, and partly beyond the context's volume.
std::shared_ptr<const VolumeImage> turned(const Formula& formula, ScalarType type = ScalarType::kFloat32) {
  DataSet block = sampled_block({25, 33, 21}, Vec3(0.08), type, formula);
  auto& grid = std::get<UniformTopology>(block.topology);
  grid.axes = Mat3(Vec3(0.07, 0.03, 0.0), Vec3(-0.02, 0.05, 0.0), Vec3(0.0, 0.0, 0.09));
  grid.origin = -0.5 * (grid.axes * Vec3(grid.points - 1)) + Vec3(0.4, -0.1, 0.1);
  return make_volume_image(block, "s", "test");
}

// The colours of lenses, spread over the values of `image`: whole numbers go up to 255 or 65535.
ColorTransfer colors_of(const VolumeImage& image) {
  return spread(focus_colors(), image.lowest, image.highest);
}

// Around: blobs. In each lens: shells, on a finer grid, on a turned one, or both.
VolumeView many_fields() {
  VolumeView view = plain_view();
  view.fields = {
      {sampled_view(shells, ScalarType::kUint16, 45).image, "fine"},
      {turned(shells), "turned"},
      {sampled_view([](const Vec3& x) { return blobs(0.8 * x + 0.3); }, ScalarType::kFloat32, 21).image,
       "coarse"}};
  return view;
}

TEST(FieldPicture, AgreesWithTheReferenceForEveryShapeOfLens) {
  VolumePicture picture(kSize, kSize);
  VolumeView view = many_fields();
  for (const auto& [name, lens] : lenses()) {
    view.lenses = {lens};
    view.lenses[0].field = 1;
    view.lenses[0].transfer = colors_of(*view.fields[0].image);
    expect_agreement(picture, view, camera_of(view), name + ", finer", kBar);
    view.lenses[0].field = 2;
    view.lenses[0].transfer = colors_of(*view.fields[1].image);
    expect_agreement(picture, view, camera_of(view, {.azimuth = 100.0, .elevation = 20.0}), name + ", turned",
                     kBar);
  }
  view.lenses = {lenses()[0].lens};
  view.lenses[0].field = 2;
  view.cuts = {{.kept = {glm::normalize(Vec3(1.0, 2.0, -0.5)), 0.3}}};
  view.lenses[0].shading = true;
  view.fields[1].image = turned(blobs);  // without creases, at which light changes at once
  expect_agreement(picture, view, camera_of(view, {}, Projection::kOrthographic), "cut, and under light",
                   kBar);
}

TEST(FieldPicture, AgreesWithTheReferenceForEveryTypeOfNumberOnATurnedGrid) {
  VolumePicture picture(kSize, kSize);
  VolumeView view = plain_view();
  view.lenses = {lenses()[0].lens};
  view.lenses[0].field = 1;
  const auto expect_agreement_of = [&](const Formula& formula, ScalarType type, bool shading) {
    view.fields = {{turned(formula, type), "turned"}};
    view.lenses[0].transfer = colors_of(*view.fields[0].image);
    view.lenses[0].shading = shading;
    expect_agreement(picture, view, camera_of(view, {.azimuth = 100.0, .elevation = 20.0}),
                     std::string(name_of(type)) + (shading ? ", lit" : ""), kBar);
  };
  for (const ScalarType type : {ScalarType::kUint8, ScalarType::kUint16, ScalarType::kFloat32}) {
    expect_agreement_of(shells, type, false);
    expect_agreement_of(blobs, type, true);  // without creases, at which light changes at once
  }
}

TEST(FieldPicture, AgreesWithTheReferenceForFourFieldsAtOnce) {
  VolumePicture picture(kSize, kSize);
  VolumeView view = many_fields();
  Lens first{make_sphere({0.2, 0.0, 0.0}, 0.5)}, second{make_box({0.5, 0.0, 0.1}, Mat3(0.6))};
  Lens third{make_cylinder({0.0, -0.9, 0.0}, {0.0, 0.9, 0.0}, 0.3)},
      fourth{make_sphere({-0.6, 0.3, 0.1}, 0.4)};
  first.field = 1;
  first.transfer = colors_of(*view.fields[0].image);
  second.field = 2;
  second.regions = spread(RegionTransfer({{.shape = TransferRegion::Shape::kEllipse,
                                           .corners = {Vec2(0.2, 0.1), Vec2(0.8, 1.1), Vec2(0.0)},
                                           .color = {0.9F, 0.7F, 0.1F},
                                           .opacity = 0.1,
                                           .soft = 0.7}}),
                          place_range(*view.fields[1].image));
  third.field = 3;                   // in the colours of the context, which are of values that both have
  fourth.transfer = focus_colors();  // the same as the first, of another field
  for (Lens* lens : {&first, &second, &third, &fourth}) lens->shading = false;
  view.lenses = {first, second, third, fourth};
  expect_agreement(picture, view, camera_of(view), "four fields", kBar);
  view.lenses = {third, fourth, second, first};
  view.skip_empty = false;
  view.lenses[0].magnification = 1.5;
  expect_agreement(picture, view, camera_of(view, {.azimuth = 200.0, .elevation = -30.0}), "in another order",
                   kBar);
}

// The same voxels as another field change nothing.
TEST(FieldPicture, OfTheSameVoxelsIsThatOfOneField) {
  VolumePicture picture(kSize, kSize);
  VolumeView view = plain_view();
  const Camera camera = camera_of(view);
  view.lenses = {lenses()[1].lens};
  const FloatImage one = picture.draw(view, camera);
  view.fields = {{std::make_shared<const VolumeImage>(*view.image), "again"}};
  view.lenses[0].field = 1;
  EXPECT_LE(worst_difference(picture.draw(view, camera), one), kBound);
  // The context by itself, and in bricks.
  view.context.viewport = 0.999;
  view.storage.brick_cells = 16;
  (void)picture.draw(view, camera);
  view.context.viewport = 1.0;
  EXPECT_LE(worst_difference(picture.draw(view, camera), one), kBound);
  view.lenses[0].field = 0;
  EXPECT_LE(worst_difference(picture.draw(view, camera), one), kBound);
}

TEST(FieldPicture, TakesMemoryForThoseAloneThatALensShows) {
  VolumePicture picture(16, 16);
  VolumeView view = many_fields();
  const std::uint64_t context = view.image->bytes.size();
  (void)picture.draw(view, camera_of(view));
  EXPECT_EQ(picture.cost().voxel_bytes, context);
  view.lenses = {lenses()[0].lens};
  view.lenses[0].field = 2;
  (void)picture.draw(view, camera_of(view));
  EXPECT_EQ(picture.cost().voxel_bytes, context + view.fields[1].image->bytes.size());
  view.lenses[0].cut = true;
  (void)picture.draw(view, camera_of(view));
  EXPECT_EQ(picture.cost().voxel_bytes, context);
  // In no more memory than given: from coarser voxels.
  view.lenses[0].cut = false;
  view.lenses[0].field = 1;
  view.storage.memory = 2 * context;
  (void)picture.draw(view, camera_of(view));
  EXPECT_LE(picture.cost().voxel_bytes, 2 * context);
  EXPECT_GT(picture.cost().voxel_bytes, context);
}

}  // namespace
}  // namespace palpate::test
