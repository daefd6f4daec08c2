// What the interpolants give between the points of each kind of grid.
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/common/field/sampled_fields.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/sample_meshes.h"

namespace palpate {
namespace {

using test::field_of;
using test::kVelocity;
using test::Linear;
using test::linear;
using test::on_all_grids;
using test::random_in;
using test::unit;

TEST(VectorField, LinearFieldsAreExactOnEveryGrid) {
  std::mt19937_64 random(1);
  const Linear formula;
  for (const DataSet& block : on_all_grids(formula, 7)) {
    const auto field = field_of(block);
    CellHint hint;
    for (int i = 0; i < 500; ++i) {
      const Vec3 x = random_in(formula.bounds(), random);
      const VectorSample sample = field->sample(x, hint);
      ASSERT_EQ(sample.status, SampleStatus::kOk);
      EXPECT_LT(glm::distance(sample.value, formula.velocity(x)), 1e-13);
      Mat3 m;
      ASSERT_EQ(field->jacobian(x, hint, m), SampleStatus::kOk);
      for (int c = 0; c < 3; ++c) EXPECT_LT(glm::distance(m[c], Linear::matrix()[c]), 1e-11);
    }
  }
}

// log2 of the ratio of errors when the cells are halved twice.
TEST(VectorField, InterpolantsConvergeWithOrderTwoAndDerivativesWithOrderOne) {
  const auto formula = example("abc");
  std::array<std::vector<double>, 4> value_errors;
  std::array<std::vector<double>, 4> jacobian_errors;
  for (const int n : {9, 17, 33}) {
    const auto blocks = on_all_grids(*formula, n);
    for (std::size_t g = 0; g < blocks.size(); ++g) {
      const auto field = field_of(blocks[g]);
      std::mt19937_64 random(5);
      CellHint hint;
      double value_error = 0.0;
      double jacobian_error = 0.0;
      constexpr int kSamples = 2000;
      for (int i = 0; i < kSamples; ++i) {
        const Vec3 x = random_in(formula->bounds(), random);
        const Vec3 dv = field->sample(x, hint).value - formula->velocity(x);
        value_error += glm::dot(dv, dv);
        Mat3 m;
        ASSERT_EQ(field->jacobian(x, hint, m), SampleStatus::kOk);
        const Mat3 dm = m - formula->jacobian(x);
        for (int c = 0; c < 3; ++c) jacobian_error += glm::dot(dm[c], dm[c]);
      }
      value_errors[g].push_back(std::sqrt(value_error / kSamples));
      jacobian_errors[g].push_back(std::sqrt(jacobian_error / kSamples));
    }
  }
  for (std::size_t g = 0; g < 4; ++g) {
    // The cell counts n - 1, n and n - 2 are not exactly doubled, and grids differ a little in shape.
    EXPECT_NEAR(std::log2(value_errors[g][1] / value_errors[g][2]), 2.0, 0.2) << g;
    EXPECT_NEAR(std::log2(jacobian_errors[g][1] / jacobian_errors[g][2]), 1.0, 0.2) << g;
  }
}

TEST(VectorField, MixedCellsInAnyNumberingGiveTheLinearField) {
  std::mt19937_64 random(4);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const double jitter : {0.0, 0.15}) {
      const auto field = field_of(test::mixed_cells(4, jitter, seed, linear));
      CellHint hint;
      for (int i = 0; i < 500; ++i) {
        const Vec3 x{unit(random), unit(random), unit(random)};
        const VectorSample sample = field->sample(x, hint);
        ASSERT_EQ(sample.status, SampleStatus::kOk);
        EXPECT_LT(glm::distance(sample.value, linear(x)), 1e-12);
      }
    }
  }
}

TEST(VectorField, JoinedBlocksGiveTheLinearFieldAcrossTheirBorders) {
  std::mt19937_64 random(4);
  const auto blocks = test::turned_blocks(3, 0.0, 3, linear);
  const auto field = make_vector_field(blocks, kVelocity, "test");
  CellHint hint;
  for (int i = 0; i < 1000; ++i) {
    Vec3 x{unit(random), unit(random), unit(random)};
    if (i % 4 == 0) x[i % 3] = 0.5;
    const VectorSample sample = field->sample(x, hint);
    ASSERT_EQ(sample.status, SampleStatus::kOk);
    EXPECT_LT(glm::distance(sample.value, linear(x)), 1e-12);
  }
}

TEST(VectorField, SamplesOutsideAreZeroAndSaySo) {
  for (const DataSet& block : on_all_grids(Linear(), 5)) {
    const auto field = field_of(block);
    CellHint hint;
    const VectorSample sample = field->sample({5.0, 5.0, 5.0}, hint);
    EXPECT_EQ(sample.status, SampleStatus::kOutside);
    EXPECT_EQ(sample.value, Vec3{0.0});
  }
}

TEST(VectorField, SamplingAllocatesNothing) {
  const auto blocks = on_all_grids(Linear(), 6);
  for (const DataSet& block : blocks) {
    const auto field = field_of(block);
    const test::AllocationGuard guard;
    CellHint hint;
    Mat3 m;
    for (int i = 0; i < 100; ++i) {
      const Vec3 x{0.01 * i, 1.0, 1.5};
      (void)field->sample(x, hint);
      (void)field->jacobian(x, hint, m);
    }
    EXPECT_EQ(guard.count(), 0U);
  }
}

}  // namespace
}  // namespace palpate
