#include "common/render/tensor/tensor_glyphs.h"

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/tensor/peak_field.h"
#include "tests/common/render/tensor/sample_tensors.h"

namespace palpate::test {
namespace {

Mat3 tensor_of(const Vec3& values, const Mat3& frame) {
  Mat3 sum{0.0};
  for (int i = 0; i < 3; ++i) sum += values[i] * glm::outerProduct(frame[i], frame[i]);
  return sum;
}

const Mat3 kFrame{Vec3{0.6, 0.8, 0.0}, Vec3{-0.8, 0.6, 0.0}, Vec3{0.0, 0.0, 1.0}};

TEST(TensorGlyph, HasAxesAsLongAsEigenvaluesSay) {
  const TensorGlyph glyph = make_glyph(tensor_of({2.0, 0.9, 0.5}, kFrame), GlyphShape::kEllipsoid,
                                       TensorColor::kDirection, Vec3(4.0), 3.0, {});
  // c_l > c_p: the pole is e_1.
  EXPECT_NEAR(glm::length(glyph.axis_z), 3.0F, 1e-6F);
  EXPECT_NEAR(glm::length(glyph.axis_x), 1.35F, 1e-6F);
  EXPECT_NEAR(glm::length(glyph.axis_y), 0.75F, 1e-6F);
  EXPECT_NEAR(std::abs(glm::dot(Vec3(glyph.axis_z), kFrame[0])), 3.0, 1e-6);
  EXPECT_GT(glm::dot(glm::cross(glyph.axis_x, glyph.axis_y), glyph.axis_z), 0.0F);
  EXPECT_EQ(glyph.alpha, 1.0F);
  EXPECT_EQ(glyph.beta, 1.0F);
  EXPECT_NEAR(glyph.color.r, 0.6F, 1e-6F);
  EXPECT_NEAR(glyph.color.g, 0.8F, 1e-6F);
}

TEST(TensorGlyph, SuperquadricsAreCylindersWhereLinearAndDiscsWherePlanar) {
  const auto glyph_of = [](const Vec3& values) {
    return make_glyph(tensor_of(values, kFrame), GlyphShape::kSuperquadric, TensorColor::kFa, Vec3(0.0), 1.0,
                      {});
  };
  const TensorGlyph cylinder = glyph_of({1.0, 0.0, 0.0});
  EXPECT_EQ(cylinder.alpha, 1.0F);  // round about e_1
  EXPECT_EQ(cylinder.beta, 0.05F);  // with flat ends
  EXPECT_NEAR(std::abs(glm::dot(Vec3(cylinder.axis_z), kFrame[0])), 1.0, 1e-6);
  EXPECT_NEAR(glm::length(cylinder.axis_x), 0.05F, 1e-6F);
  EXPECT_NEAR(cylinder.color.r, 1.0F, 1e-6F);

  const TensorGlyph disc = glyph_of({1.0, 1.0, 0.0});
  EXPECT_EQ(disc.alpha, 1.0F);
  EXPECT_EQ(disc.beta, 0.05F);
  EXPECT_NEAR(std::abs(glm::dot(Vec3(disc.axis_z), kFrame[2])), 0.05, 1e-6);

  const TensorGlyph ball = glyph_of({1.0, 1.0, 1.0});
  EXPECT_EQ(ball.alpha, 1.0F);
  EXPECT_EQ(ball.beta, 1.0F);

  // c_l = 0.5, c_p = 0.25.
  const TensorGlyph between = glyph_of({5.0, 2.0, 1.0});
  EXPECT_NEAR(between.alpha, std::pow(1.0 - 2.0 / 8.0, 3.0), 1e-6);
  EXPECT_NEAR(between.beta, std::pow(1.0 - 3.0 / 8.0, 3.0), 1e-6);
}

TEST(TensorGlyph, IsFiniteWithNegativeEigenvaluesAndAtExtremeScales) {
  for (const double scale : {1e-300, 1.0, 1e300}) {
    const TensorGlyph glyph = make_glyph(tensor_of({scale, -0.3 * scale, -0.5 * scale}, kFrame),
                                         GlyphShape::kSuperquadric, TensorColor::kFa, Vec3(0.0), 1.0, {});
    for (const Vec3f& axis : {glyph.axis_x, glyph.axis_y, glyph.axis_z}) {
      EXPECT_TRUE(is_finite(Vec3(axis)));
      EXPECT_GE(glm::length(axis), 0.0499F);
    }
  }
}

TEST(GlyphStride, SpreadsThemEvenlyOverLongVoxels) {
  const auto image = sampled_tensors(
      centred_lattice({20, 20, 20}, Mat3{Vec3{1.0, 0.0, 0.0}, Vec3{0.0, 2.0, 0.0}, Vec3{0.0, 0.0, 4.0}}),
      [](const Vec3&) { return Mat3(1.0); });
  EXPECT_EQ(glyph_stride(*image, 0.0), Index3(1, 1, 1));
  EXPECT_EQ(glyph_stride(*image, 4.0), Index3(4, 2, 1));
  EXPECT_EQ(glyph_stride(*image, 1e300), Index3(20, 20, 20));
}

TEST(SliceGlyphs, StandOnTheSlicesThatAreShownWhereThereIsEnoughAnisotropy) {
  const auto image = sampled_tensors(centred_lattice({8, 6, 4}, Mat3(2.0)), [](const Vec3& x) {
    return x.x > 0.0 ? linear_tensor({0.0, 1.0, 0.0}) : Mat3(1e-3);
  });
  TensorView view{.image = image, .position = image->position({5.0, 2.0, 1.0})};
  view.glyphs = GlyphShape::kEllipsoid;
  view.slices = {false, true, false};
  const SceneFrame frame = scene_frame(image->bounds());
  const auto glyphs = make_slice_glyphs(view, frame, Index3(1));
  ASSERT_EQ(glyphs.size(), 4U * 4U);  // the half with x > 0, and all of z
  const float y = Vec3f(frame.scene_from_data(view.position)).y;
  for (const TensorGlyph& glyph : glyphs) {
    EXPECT_FLOAT_EQ(glyph.center.y, y);
    EXPECT_NEAR(glm::length(glyph.axis_z) * power_of_two(frame.exponent), 1.0, 1e-6);  // half a voxel
  }
  EXPECT_EQ(make_slice_glyphs(view, frame, {2, 2, 2}).size(), 2U * 2U);
  view.glyph_least_fa = 0.99;
  EXPECT_TRUE(make_slice_glyphs(view, frame, Index3(1)).empty());
  view.glyph_least_fa = 0.0;
  EXPECT_EQ(make_slice_glyphs(view, frame, Index3(1)).size(), 8U * 4U);
}

// Of two directions a voxel both stand there, each as long as it is beside the longer; a third that is zero, and one below
// the least anisotropy, have none.
TEST(SliceGlyphs, ShowEveryPeakOfAVoxel) {
  const UniformTopology lattice = centred_lattice({4, 4, 2}, Mat3(2.0));
  std::vector<float> tensors, peaks;
  for (int v = 0; v < 32; ++v) {
    const Mat3 d = fibre_tensor({1.0, 0.0, 0.0}, 0.8);
    for (const double number : {d[0][0], d[1][0], d[2][0], d[1][1], d[2][1], d[2][2]})
      tensors.push_back(static_cast<float>(number));
    for (const float number : {0.0F, 0.4F, 0.0F, 0.0F, 0.0F, 0.0F, 0.8F, 0.0F, 0.0F}) peaks.push_back(number);
  }
  DataSet block;
  block.topology = lattice;
  block.arrays = {make_array("D", Association::kPoint, 6, std::span<const float>(tensors)),
                  make_array("P", Association::kPoint, 9, std::span<const float>(peaks))};
  const auto image =
      make_tensor_voxels(make_tensor_field(block, {.array = "D", .peaks = "P"}, "test"), "test");
  TensorView view{.image = image, .position = image->position({1.0, 1.0, 1.0})};
  view.glyphs = GlyphShape::kEllipsoid;
  view.slices = {false, false, true};
  const SceneFrame frame = scene_frame(image->bounds());
  const auto glyphs = make_slice_glyphs(view, frame, Index3(1));
  ASSERT_EQ(glyphs.size(), 2U * 16U);
  const double scale = power_of_two(frame.exponent);
  const auto is = [&](const TensorGlyph& glyph, const Vec3& half, const Rgb& color) {
    EXPECT_NEAR(glm::length(glm::cross(scale * Vec3(glyph.axis_z), half)), 0.0, 1e-6);
    EXPECT_NEAR(glm::length(glyph.axis_z) * scale, glm::length(half), 1e-6);
    EXPECT_LT(glm::length(glyph.axis_x), 0.3F * glm::length(glyph.axis_z)) << "a needle";
    EXPECT_EQ(glyph.color, color);
  };
  is(glyphs[0], {0.0, 0.5, 0.0}, {0.0F, 1.0F, 0.0F});
  is(glyphs[1], {1.0, 0.0, 0.0}, {1.0F, 0.0F, 0.0F});
  EXPECT_EQ(glyphs[0].center, glyphs[1].center);
  view.color = TensorColor::kFa;
  const auto grey = make_slice_glyphs(view, frame, Index3(1));
  EXPECT_NEAR(grey[0].color.r, 0.4F, 1e-6F);
  EXPECT_NEAR(grey[1].color.r, 0.8F, 1e-6F);
  view.glyph_least_fa = 0.5;
  EXPECT_EQ(make_slice_glyphs(view, frame, Index3(1)).size(), 16U);
}

}  // namespace
}  // namespace palpate::test
