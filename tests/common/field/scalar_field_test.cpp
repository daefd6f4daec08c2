#include "common/field/scalar_field.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/analytic/examples.h"
#include "common/field/grid/box_grid.h"
#include "tests/support/sample_meshes.h"
#include "tests/support/sampled.h"

namespace palpate {
namespace {

const VectorChoice kVelocity{VectorChoice::Kind::kArray, Association::kPoint, {"velocity"}, "velocity"};

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }

double linear(const Vec3& x) { return 1.0 + 2.0 * x.x - 3.0 * x.y + 0.5 * x.z; }

/// Positions of a block's points, in the data's order.
std::vector<Vec3> positions_of(const DataSet& block) {
  std::vector<Vec3> out;
  if (const auto* grid = std::get_if<UniformTopology>(&block.topology)) {
    for (int k = 0; k < grid->points.z; ++k) {
      for (int j = 0; j < grid->points.y; ++j) {
        for (int i = 0; i < grid->points.x; ++i) out.push_back(grid->origin + grid->axes * Vec3(i, j, k));
      }
    }
    return out;
  }
  const auto* curved = std::get_if<StructuredTopology>(&block.topology);
  const DataArray& points =
      curved != nullptr ? curved->positions : std::get<UnstructuredTopology>(block.topology).positions;
  for (std::size_t p = 0; p < points.tuples; ++p)
    out.emplace_back(points.at(p, 0), points.at(p, 1), points.at(p, 2));
  return out;
}

DataSet with_scalar(DataSet block, bool use_double) {
  std::vector<double> numbers;
  for (const Vec3& x : positions_of(block)) numbers.push_back(linear(x));
  const std::vector<float> floats(numbers.begin(), numbers.end());
  block.arrays.push_back(use_double
                             ? make_array("t", Association::kPoint, 1, std::span<const double>(numbers))
                             : make_array("t", Association::kPoint, 1, std::span<const float>(floats)));
  return block;
}

TEST(ScalarField, LinearFieldsAndTheirGradientsAreExactOnEveryGrid) {
  const auto formula = example("cavity");
  std::mt19937_64 random(1);
  for (DataSet block :
       {test::sample_uniform(*formula, {6, 7, 8}), test::sample_curvilinear(*formula, {6, 7, 8}),
        test::sample_tetrahedra(*formula, {6, 7, 8})}) {
    block = with_scalar(std::move(block), true);
    const auto field = make_vector_field({block}, kVelocity, "test");
    const auto scalar = make_scalar_field(*field, {block}, {"t"}, "test");
    CellHint hint;
    for (int i = 0; i < 300; ++i) {
      const Vec3 x{unit(random), unit(random), unit(random)};
      const ScalarSample sample = scalar->sample(x, hint);
      ASSERT_EQ(sample.status, SampleStatus::kOk);
      EXPECT_NEAR(sample.value, linear(x), 1e-13);
      EXPECT_LT(glm::distance(scalar->gradient(x, hint).value, Vec3(2.0, -3.0, 0.5)), 1e-11);
    }
    EXPECT_NEAR(scalar->lowest(), -2.0, 1e-12);
    EXPECT_NEAR(scalar->highest(), 3.5, 1e-12);
  }
}

/// Axes of medical images: along those of the world or turned, each rising or falling, right-handed or not.
std::vector<Mat3> image_axes() {
  const Mat3 turned{Vec3{0.6, 0.8, 0.0}, Vec3{-0.8, 0.6, 0.0}, Vec3{0.0, 0.0, 1.0}};
  const Mat3 upright{Vec3{0.0, 0.0, 1.0}, Vec3{1.0, 0.0, 0.0}, Vec3{0.0, 1.0, 0.0}};
  const Mat3 leaning{Vec3{1.0, 0.0, 0.0}, Vec3{0.2, 1.0, 0.0}, Vec3{0.1, -0.3, 1.0}};
  std::vector<Mat3> out;
  for (const Mat3& axes : {Mat3{1.0}, turned, upright, leaning}) {
    for (int signs = 0; signs < 8; ++signs) {
      Mat3 image = axes;
      for (int axis = 0; axis < 3; ++axis) image[axis] *= ((signs >> axis) & 1 ? -1.0 : 1.0) * (0.5 + axis);
      out.push_back(image);
    }
  }
  return out;
}

// A copy of the voxels of a CT would double the memory that a window takes.
TEST(ScalarField, VoxelsOfAnyAxesStayWhereTheyLie) {
  std::mt19937_64 random(12);
  for (const Mat3& axes : image_axes()) {
    const Index3 points{4, 3, 5};
    const Vec3 origin{7.0, -20.0, 3.0};
    std::vector<float> values;
    for (int k = 0; k < points.z; ++k) {
      for (int j = 0; j < points.y; ++j) {
        for (int i = 0; i < points.x; ++i) values.push_back(static_cast<float>(1 + 2 * i - 30 * j + 5 * k));
      }
    }
    DataSet block;
    block.topology = UniformTopology{points, origin, axes};
    block.arrays = {make_array("t", Association::kPoint, 1, std::span<const float>(values))};
    const auto field = make_scalar_field({block}, {"t"}, "test");
    const auto* kept = std::get_if<std::span<const float>>(&field->values().values);
    ASSERT_NE(kept, nullptr);
    EXPECT_EQ(static_cast<const void*>(kept->data()), block.arrays.front().bytes.data());
    CellHint hint;
    const Vec3 gradient = Vec3{2.0, -30.0, 5.0} * glm::inverse(axes);
    for (int i = 0; i < 30; ++i) {
      const Vec3 g = Vec3{unit(random), unit(random), unit(random)} * Vec3(points - 1), x = origin + axes * g;
      ASSERT_EQ(field->sample(x, hint).status, SampleStatus::kOk);
      EXPECT_NEAR(field->sample(x, hint).value, 1.0 + glm::dot(Vec3{2.0, -30.0, 5.0}, g), 1e-11);
      EXPECT_LT(glm::distance(field->gradient(x, hint).value, gradient), 1e-10 * glm::length(gradient));
    }
  }
}

/// Any axes: turned, mirrored, sheared, of unlike steps.
Mat3 random_axes(std::mt19937_64& random) {
  for (;;) {
    Mat3 axes;
    for (int axis = 0; axis < 3; ++axis) {
      for (int row = 0; row < 3; ++row) axes[axis][row] = 2.0 * unit(random) - 1.0;
      axes[axis] *= std::exp2(4.0 * unit(random)) / glm::length(axes[axis]);
    }
    const double volume =
        glm::determinant(axes) / (glm::length(axes[0]) * glm::length(axes[1]) * glm::length(axes[2]));
    if (std::abs(volume) > 0.1) return axes;
  }
}

// On any lattice the interpolant is the polynomial in lattice coordinates g: x = origin + axes g. With values
// c.g + q g_x g_y g_z over one cell its value, gradient and Hessian in the world are those by the chain rule.
TEST(ScalarField, LatticesOfAnyAxesAreInterpolatedWithoutTetrahedra) {
  std::mt19937_64 random(5);
  int mirrored = 0;
  for (int lattice = 0; lattice < 50; ++lattice) {
    const Mat3 axes = random_axes(random);
    mirrored += glm::determinant(axes) < 0.0 ? 1 : 0;
    const Vec3 origin{10.0 * unit(random), -5.0, 3.0 * unit(random)};
    const Vec3 c{1.0 + unit(random), -2.0, unit(random)};
    const double q = lattice % 2 == 0 ? 0.0 : 0.7;  // of trilinear ones one cell alone is exact
    const Index3 points = lattice % 2 == 0 ? Index3{4, 5, 6} : Index3{2, 2, 2};
    DataSet block;
    block.topology = UniformTopology{points, origin, axes};
    std::vector<double> values;
    for (int k = 0; k < points.z; ++k) {
      for (int j = 0; j < points.y; ++j) {
        for (int i = 0; i < points.x; ++i) values.push_back(glm::dot(c, Vec3(i, j, k)) + q * i * j * k);
      }
    }
    block.arrays = {make_array("t", Association::kPoint, 1, std::span<const double>(values))};
    const auto field = make_scalar_field({block}, {"t"}, "test");
    ASSERT_NE(field->box_grid(), nullptr);
    ASSERT_TRUE(field->box_grid()->sheared());
    const Mat3 inverse = glm::inverse(axes);
    const LocalFrame& frame = field->frame();
    CellHint hint;
    for (int i = 0; i < 50; ++i) {
      const Vec3 part{unit(random), unit(random), unit(random)};
      const Vec3 g = part * Vec3(points - 1), x = origin + axes * g;
      const ScalarSample sample = field->sample(x, hint);
      ASSERT_EQ(sample.status, SampleStatus::kOk);
      EXPECT_NEAR(sample.value, glm::dot(c, g) + q * g.x * g.y * g.z, 1e-10);
      const Vec3 along = c + q * Vec3{g.y * g.z, g.z * g.x, g.x * g.y};
      const Vec3 gradient = along * inverse;  // inverse^T along
      EXPECT_LT(glm::distance(field->gradient(x, hint).value, gradient), 1e-9 * glm::length(gradient));
      const Mat3 bend = q * Mat3{Vec3{0.0, g.z, g.y}, Vec3{g.z, 0.0, g.x}, Vec3{g.y, g.x, 0.0}};
      Jet3 jet;
      ASSERT_EQ(field->jet(frame.local_from_data(x), hint, jet), SampleStatus::kOk);
      const double unit_of_hessian = field->value_scale() * frame.length_scale() * frame.length_scale();
      const Mat3 hessian = glm::transpose(frame.rotation) * glm::transpose(inverse) * bend * inverse *
                           frame.rotation * unit_of_hessian;
      for (int axis = 0; axis < 3; ++axis) EXPECT_LT(glm::distance(jet.hessian[axis], hessian[axis]), 1e-8);
    }
    // Its own points are in it, those of the border, too, whatever rounding does to their places.
    for (int k = 0; k < points.z; ++k) {
      for (int j = 0; j < points.y; ++j) {
        for (int i = 0; i < points.x; ++i) {
          const ScalarSample sample = field->sample(origin + axes * Vec3(i, j, k), hint);
          ASSERT_EQ(sample.status, SampleStatus::kOk) << lattice << ": " << i << " " << j << " " << k;
          EXPECT_NEAR(sample.value, glm::dot(c, Vec3(i, j, k)) + q * i * j * k, 1e-10);
        }
      }
    }
    // What lies beside the lattice, but in its bounding box, is outside.
    const Vec3 beside = origin + axes * (Vec3(points - 1) * Vec3{0.5, 1.02, 0.5});
    EXPECT_EQ(field->sample(beside, hint).status, SampleStatus::kOutside);
    EXPECT_TRUE(field->bounds().contains(origin + axes * (Vec3(points - 1) * Vec3{0.5})));
    for (const int corner : {0, 1, 2, 3, 4, 5, 6, 7}) {
      const Vec3 at = origin + axes * (Vec3(points - 1) * Vec3(corner & 1, corner >> 1 & 1, corner >> 2));
      EXPECT_TRUE(glm::all(glm::greaterThanEqual(at, field->bounds().lower - 1e-12)));
      EXPECT_TRUE(glm::all(glm::lessThanEqual(at, field->bounds().upper + 1e-12)));
    }
  }
  EXPECT_GT(mirrored, 10);
}

TEST(ScalarField, AxesAllButInOnePlaneAreSplitIntoTetrahedra) {
  DataSet block;
  block.topology =
      UniformTopology{Index3{2}, Vec3{0.0}, Mat3{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{1, 1, 0.01}}};
  const std::vector<float> values(8, 1.0F);
  block.arrays = {make_array("t", Association::kPoint, 1, std::span<const float>(values))};
  EXPECT_EQ(make_scalar_field({block}, {"t"}, "test")->box_grid(), nullptr);
}

TEST(ScalarField, AxesInOnePlaneAreRefused) {
  DataSet block;
  block.topology =
      UniformTopology{Index3{2}, Vec3{0.0}, Mat3{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{1, 1, 1e-9}}};
  const std::vector<float> values(8, 1.0F);
  block.arrays = {make_array("t", Association::kPoint, 1, std::span<const float>(values))};
  EXPECT_THROW((void)make_scalar_field({block}, {"t"}, "test"), Error);
}

TEST(ScalarField, JoinedBlocksBringTheirValuesAlong) {
  const auto zero = [](const Vec3&) { return Vec3{1.0, 0.0, 0.0}; };
  std::vector<DataSet> blocks = test::turned_blocks(3, 0.0, 2, zero);
  for (DataSet& block : blocks) block = with_scalar(std::move(block), true);
  const auto field = make_vector_field(blocks, kVelocity, "test");
  const auto scalar = make_scalar_field(*field, blocks, {"t"}, "test");
  std::mt19937_64 random(1);
  CellHint hint;
  for (int i = 0; i < 300; ++i) {
    const Vec3 x{unit(random), unit(random), unit(random)};
    EXPECT_NEAR(scalar->sample(x, hint).value, linear(x), 1e-12);
  }
}

TEST(ScalarField, ComponentsAndMagnitudesOfVectorsAreScalars) {
  const auto formula = example("cavity");
  const DataSet block = test::sample_uniform(*formula, {9, 9, 9}, test::SampledType::kFloat64);
  const auto field = make_vector_field({block}, kVelocity, "test");
  const auto z = make_scalar_field(*field, {block}, {"velocity", Association::kPoint, 2}, "test");
  const auto size =
      make_scalar_field(*field, {block}, {"velocity", Association::kPoint, ScalarChoice::kMagnitude}, "test");
  CellHint hint;
  const Vec3 node{0.25, 0.5, 0.875};  // a grid point
  EXPECT_DOUBLE_EQ(z->sample(node, hint).value, formula->velocity(node).z);
  EXPECT_DOUBLE_EQ(size->sample(node, hint).value, glm::length(formula->velocity(node)));
}

TEST(ScalarField, OutsideAndNaNSaySo) {
  DataSet block = with_scalar(test::sample_uniform(*example("cavity"), {5, 5, 5}), false);
  std::vector<float> numbers;
  for (std::size_t i = 0; i < 125; ++i) numbers.push_back(static_cast<float>(block.arrays[1].at(i)));
  numbers[0] = std::numeric_limits<float>::quiet_NaN();
  block.arrays[1] = make_array("t", Association::kPoint, 1, std::span<const float>(numbers));
  const auto field = make_vector_field({block}, kVelocity, "test");
  const auto scalar = make_scalar_field(*field, {block}, {"t"}, "test");
  CellHint hint;
  EXPECT_EQ(scalar->sample({0.1, 0.1, 0.1}, hint).status, SampleStatus::kBadData);
  EXPECT_EQ(scalar->gradient({0.1, 0.1, 0.1}, hint).status, SampleStatus::kBadData);
  EXPECT_EQ(scalar->sample({0.5, 0.5, 0.5}, hint).status, SampleStatus::kOk);
  EXPECT_EQ(scalar->sample({1.5, 0.5, 0.5}, hint).status, SampleStatus::kOutside);
  EXPECT_EQ(scalar->gradient({1.5, 0.5, 0.5}, hint).status, SampleStatus::kOutside);
}

TEST(ScalarField, WrongRequestsAreRefused) {
  const DataSet block = with_scalar(test::sample_uniform(*example("cavity"), {5, 5, 5}), false);
  const auto field = make_vector_field({block}, kVelocity, "test");
  EXPECT_THROW((void)make_scalar_field(*field, {block}, {"none"}, "test"), Error);
  EXPECT_THROW((void)make_scalar_field(*field, {block}, {"t", Association::kCell}, "test"), Error);
  EXPECT_THROW((void)make_scalar_field(*field, {block}, {"t", Association::kPoint, 1}, "test"), Error);
  EXPECT_THROW((void)make_scalar_field(*field, {}, {"t"}, "test"), Error);
  const DataSet other = with_scalar(test::sample_uniform(*example("cavity"), {5, 5, 6}), false);
  EXPECT_THROW((void)make_scalar_field(*field, {other}, {"t"}, "test"), Error);
  const auto formula = make_vector_field(example("abc"));
  EXPECT_THROW((void)make_scalar_field(*formula, {block}, {"t"}, "test"), Error);
}

TEST(ScalarField, StandsAloneOnVolumesOfAnyType) {
  // The number of the point, in each type, over a uniform grid: linear, so exact between the points too.
  const Index3 n{4, 5, 6};
  UniformTopology topology;
  topology.points = n;
  topology.origin = {10.0, 0.0, -3.0};
  topology.axes = Mat3{0.5};
  std::vector<float> floats;
  for (int i = 0; i < n.x * n.y * n.z; ++i) floats.push_back(static_cast<float>(i));
  const std::vector<std::uint8_t> bytes(floats.begin(), floats.end());
  const std::vector<std::int16_t> shorts(floats.begin(), floats.end());
  const std::vector<std::uint16_t> words(floats.begin(), floats.end());
  const std::vector<std::int32_t> longs(floats.begin(), floats.end());
  const auto array = [&](const auto& values, ScalarType type) {
    DataArray out = make_array("t", Association::kPoint, 1, std::span<const float>(floats));
    out.type = type;
    out.bytes = std::as_bytes(std::span(values));
    return out;
  };
  std::vector<DataArray> arrays{array(floats, ScalarType::kFloat32), array(bytes, ScalarType::kUint8),
                                array(shorts, ScalarType::kInt16), array(words, ScalarType::kUint16),
                                array(longs, ScalarType::kInt32)};
  for (const DataArray& each : arrays) {
    DataSet block;
    block.topology = topology;
    block.arrays = {each};
    const auto field = make_scalar_field({block}, {"t"}, "test");
    ASSERT_NE(field->grid(), nullptr);
    EXPECT_EQ(field->bounds().lower, topology.origin);
    EXPECT_EQ(field->lowest(), 0.0);
    EXPECT_EQ(field->highest(), 119.0);
    EXPECT_GE(field->local_range(), 1.0);
    EXPECT_LT(field->local_range(), 2.0);
    CellHint hint;
    const Vec3 at{1.25, 2.5, 3.75};  // in points
    const Vec3 x = topology.origin + 0.5 * at;
    EXPECT_NEAR(field->sample(x, hint).value, at.x + 4.0 * (at.y + 5.0 * at.z), 1e-12);
    EXPECT_LT(glm::distance(field->gradient(x, hint).value, Vec3(2.0, 8.0, 40.0)), 1e-12);
  }
  // Along axes that run the other way, in the type that it has.
  for (const DataArray& each : {arrays[1], arrays[2], arrays[3]}) {
    DataSet block;
    UniformTopology mirrored = topology;
    mirrored.axes[0] *= -1.0;
    mirrored.axes[1] *= -1.0;
    block.topology = mirrored;
    block.arrays = {each};
    const auto field = make_scalar_field({block}, {"t"}, "test");
    EXPECT_FALSE(std::holds_alternative<std::span<const float>>(field->values().values));
    EXPECT_EQ(field->lowest(), 0.0);
    EXPECT_EQ(field->highest(), 119.0);
    CellHint hint;
    const Vec3 at{1.25, 2.5, 3.75};
    const Vec3 x = mirrored.origin + mirrored.axes * at;
    EXPECT_NEAR(field->sample(x, hint).value, at.x + 4.0 * (at.y + 5.0 * at.z), 1e-12);
  }
  // What the type already holds is not copied.
  DataSet block;
  block.topology = topology;
  block.arrays = {arrays[3]};
  const auto stored = make_scalar_field({block}, {"t"}, "test")->values();
  EXPECT_EQ(std::get<std::span<const std::uint16_t>>(stored.values).data(), words.data());
}

TEST(ScalarField, LeavesOutBlocksWithoutTheArrayAndRefusesWhereNoneHasIt) {
  const DataSet with = with_scalar(test::sample_uniform(*example("cavity"), {5, 5, 5}), false);
  const DataSet without = test::sample_uniform(*example("cavity"), {5, 5, 5});
  const auto field = make_scalar_field({without, with}, {"t"}, "test");
  ASSERT_NE(field->box_grid(), nullptr);
  EXPECT_NE(field->notes().lines.front().find("left out"), std::string::npos);
  EXPECT_THROW((void)make_scalar_field({without}, {"t"}, "test"), Error);
  EXPECT_THROW((void)make_scalar_field({with}, {"t", Association::kPoint, 2}, "test"), Error);
}

// Local values and lengths differ by powers of two alone.
TEST(ScalarField, ScalingByPowersOfTwoGivesTheSameBitsInFrameL) {
  const auto make = [](int length_exponent, int value_exponent) {
    DataSet block = with_scalar(
        test::sample_tetrahedra(*example("cavity"), {5, 5, 5}, 0.2, 1, test::SampledType::kFloat64), true);
    auto& topology = std::get<UnstructuredTopology>(block.topology);
    const auto scaled = [](const DataArray& array, int exponent) {
      std::vector<double> values;
      for (std::size_t i = 0; i < array.tuples; ++i) {
        for (int c = 0; c < array.components; ++c) values.push_back(std::ldexp(array.at(i, c), exponent));
      }
      return make_array(array.name, Association::kPoint, array.components, std::span<const double>(values));
    };
    topology.positions = scaled(topology.positions, length_exponent);
    block.arrays = {scaled(block.arrays[1], value_exponent)};
    return make_scalar_field({block}, {"t"}, "test");
  };
  const auto plain = make(0, 0);
  const auto scaled = make(70, -900);
  std::mt19937_64 random(1);
  for (int i = 0; i < 100; ++i) {
    const Vec3 x = plain->frame().local_from_data({unit(random), unit(random), unit(random)});
    CellHint hint;
    Jet3 a, b;
    ASSERT_EQ(plain->jet(x, hint, a), SampleStatus::kOk);
    ASSERT_EQ(scaled->jet(x, hint, b), SampleStatus::kOk);
    EXPECT_EQ(a.value, b.value);
    EXPECT_EQ(a.gradient, b.gradient);
  }
}

// The derivatives of the trilinear interpolant, against central differences, which are exact along an axis.
TEST(ScalarField, JetsHoldTheDerivativesOfTheCellsInterpolant) {
  std::mt19937_64 random(3);
  DataSet block = test::sample_rectilinear(*example("cavity"), {5, 6, 7});
  std::vector<double> values;
  for (int i = 0; i < 5 * 6 * 7; ++i) values.push_back(unit(random));
  block.arrays = {make_array("t", Association::kPoint, 1, std::span<const double>(values))};
  const auto field = make_scalar_field({block}, {"t"}, "test");
  constexpr double kStep = 0x1p-20;
  int asked = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 x = field->frame().local_from_data({unit(random), unit(random), unit(random)});
    Index3 cell, same;
    Jet3 at;
    CellHint hint;
    ASSERT_EQ(field->jet(x, hint, at), SampleStatus::kOk);
    ASSERT_TRUE(field->box_grid()->locate(x, cell));
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 ahead = x, behind = x;
      ahead[axis] += kStep;
      behind[axis] -= kStep;
      if (!field->box_grid()->locate(ahead, same) || same != cell) continue;
      if (!field->box_grid()->locate(behind, same) || same != cell) continue;
      ++asked;
      Jet3 a, b;
      (void)field->jet(ahead, hint, a);
      (void)field->jet(behind, hint, b);
      EXPECT_NEAR(at.gradient[axis], (a.value - b.value) / (2.0 * kStep), 1e-8);
      EXPECT_LT(glm::distance(at.hessian[axis], (a.gradient - b.gradient) / (2.0 * kStep)), 1e-7);
    }
  }
  EXPECT_GT(asked, 600);
}

TEST(ScalarField, SpeedIsThatOfTheFlow) {
  const auto formula = example("abc");
  const auto exact = make_speed_field(make_vector_field(formula, 3, -2));
  const auto sampled = make_speed_field(make_vector_field(
      {test::sample_uniform(*formula, {9, 9, 9}, test::SampledType::kFloat64)}, kVelocity, "test"));
  const Vec3 node = formula->bounds().size() * 0.25;
  CellHint hint;
  EXPECT_DOUBLE_EQ(sampled->sample(node, hint).value, glm::length(formula->velocity(node)));
  EXPECT_DOUBLE_EQ(exact->sample(8.0 * node, hint).value, 0.25 * glm::length(formula->velocity(node)));
  Jet3 at, ahead;
  ASSERT_EQ(exact->jet(node, hint, at), SampleStatus::kOk);
  constexpr double kStep = 1e-6;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 x = node;
    x[axis] += kStep;
    ASSERT_EQ(exact->jet(x, hint, ahead), SampleStatus::kOk);
    EXPECT_NEAR((ahead.value - at.value) / kStep, at.gradient[axis], 1e-5);
    EXPECT_LT(glm::distance((ahead.gradient - at.gradient) / kStep, at.hessian[axis]), 1e-5);
  }
}

}  // namespace
}  // namespace palpate
