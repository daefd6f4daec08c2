#include "common/field/scalar_field.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/analytic/examples.h"
#include "common/field/analytic/sampled.h"
#include "tests/support/sample_meshes.h"

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
  for (DataSet block : {sample_uniform(*formula, {6, 7, 8}), sample_curvilinear(*formula, {6, 7, 8}),
                        sample_tetrahedra(*formula, {6, 7, 8})}) {
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
  const DataSet block = sample_uniform(*formula, {9, 9, 9}, SampledType::kFloat64);
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
  DataSet block = with_scalar(sample_uniform(*example("cavity"), {5, 5, 5}), false);
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
  const DataSet block = with_scalar(sample_uniform(*example("cavity"), {5, 5, 5}), false);
  const auto field = make_vector_field({block}, kVelocity, "test");
  EXPECT_THROW((void)make_scalar_field(*field, {block}, {"none"}, "test"), Error);
  EXPECT_THROW((void)make_scalar_field(*field, {block}, {"t", Association::kCell}, "test"), Error);
  EXPECT_THROW((void)make_scalar_field(*field, {block}, {"t", Association::kPoint, 1}, "test"), Error);
  EXPECT_THROW((void)make_scalar_field(*field, {}, {"t"}, "test"), Error);
  const DataSet other = with_scalar(sample_uniform(*example("cavity"), {5, 5, 6}), false);
  EXPECT_THROW((void)make_scalar_field(*field, {other}, {"t"}, "test"), Error);
  const auto formula = make_vector_field(example("abc"));
  EXPECT_THROW((void)make_scalar_field(*formula, {block}, {"t"}, "test"), Error);
}

}  // namespace
}  // namespace palpate
