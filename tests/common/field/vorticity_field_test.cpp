#include "common/field/vorticity_field.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/examples.h"
#include "common/field/grid/tet_mesh.h"
#include "tests/common/field/sampled_fields.h"

namespace palpate::test {
namespace {

TEST(VorticityField, IsExactWhereTheFlowIsLinear) {
  const Vec3 exact = vorticity(Linear::matrix());
  std::mt19937_64 random(1);
  for (const DataSet& block : on_all_grids(Linear(), 7)) {
    const auto field = field_of(block);
    const VorticityField omega(field);
    CellHint hint;
    for (int i = 0; i < 300; ++i) {
      const VectorSample sample = omega.sample(random_in(Linear().bounds(), random), hint);
      ASSERT_EQ(sample.status, SampleStatus::kOk);
      ASSERT_LT(glm::distance(sample.value, exact), 1e-12);
    }
    EXPECT_EQ(omega.sample({5.0, 0.0, 0.0}, hint).status, SampleStatus::kOutside);
  }
  const VorticityField of_formula(make_vector_field(std::make_shared<Linear>()));
  CellHint hint;
  EXPECT_EQ(of_formula.sample({0.0, 1.0, 1.5}, hint).value, exact);
}

// curl v = v for the ABC flow; the error of a recovered gradient falls with the square of the cells in the
// inside of regular grids, and at least with their size everywhere.
TEST(VorticityField, ComesCloserOnFinerGrids) {
  const auto flow = example("abc");
  const auto worst = [&](int n) {
    std::vector<double> largest;
    for (const DataSet& block : on_all_grids(*flow, n)) {
      const VorticityField omega(field_of(block));
      std::mt19937_64 random(2);
      CellHint hint;
      double error = 0.0;
      for (int i = 0; i < 2000; ++i) {
        const Vec3 x = random_in(flow->bounds(), random);
        error = std::max(error, glm::distance(omega.sample(x, hint).value, flow->velocity(x)));
      }
      largest.push_back(error);
    }
    return largest;
  };
  const auto coarse = worst(12), fine = worst(24);
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    EXPECT_LT(fine[i], 0.65 * coarse[i]) << i;
    EXPECT_LT(fine[i], 0.8) << i << ", where |omega| reaches 3.5";
  }
}

TEST(VorticityField, DoesNotJumpFromCellToCell) {
  const auto flow = example("abc");
  const auto field = field_of(sample_tetrahedra(*flow, {8, 8, 8}, 0.2, 1, SampledType::kFloat64));
  const VorticityField omega(field);
  const TetMesh& mesh = *field->tet_mesh();
  double jump = 0.0, jump_of_cells = 0.0;
  int faces = 0;
  for (std::size_t c = 0; c < mesh.cells().size(); c += 7) {
    const CellIndex behind = mesh.neighbors()[c][0];
    if (behind == kNoCell) continue;
    const Vec3 middle = field->frame().data_from_local(
        mesh.position(static_cast<CellIndex>(c), {0.0, 1.0 / 3, 1.0 / 3, 1.0 / 3}));
    const Vec3 inner = field->frame().data_from_local(mesh.position(static_cast<CellIndex>(c), Vec4{0.25}));
    const Vec3 outer = field->frame().data_from_local(mesh.position(behind, Vec4{0.25}));
    CellHint a, b;
    constexpr double kNear = 1e-9;
    const Vec3 this_side = middle + kNear * (inner - middle), other_side = middle + kNear * (outer - middle);
    jump = std::max(jump, glm::distance(omega.sample(this_side, a).value, omega.sample(other_side, b).value));
    Mat3 m, n;
    (void)field->jacobian(this_side, a, m);
    (void)field->jacobian(other_side, b, n);
    jump_of_cells = std::max(jump_of_cells, glm::distance(vorticity(m), vorticity(n)));
    ++faces;
  }
  EXPECT_GT(faces, 100);
  EXPECT_LT(jump, 1e-7);
  EXPECT_GT(jump_of_cells, 0.5) << "what the cells themselves say";
}

TEST(VorticityField, SaysWhereTheDataSaysNothing) {
  DataSet block = sample_uniform(Linear(), {5, 5, 5}, SampledType::kFloat64);
  std::vector<double> values;
  for (int i = 0; i < 125; ++i) values.insert(values.end(), {1.0, 2.0, 3.0});
  values[0] = std::nan("");  // the first corner, whose cell alone is bad
  DataArray& array = block.arrays.front();
  array = make_array(array.name, array.association, 3, std::move(values));
  const VorticityField omega(field_of(block));
  CellHint hint;
  EXPECT_EQ(omega.sample(Linear().bounds().lower + Vec3{0.01}, hint).status, SampleStatus::kBadData);
  const VectorSample away = omega.sample(Linear().bounds().center(), hint);
  EXPECT_EQ(away.status, SampleStatus::kOk);
  EXPECT_EQ(away.value, Vec3(0.0));
}

TEST(VorticityField, HasTheSameBitsAtAnyScaleThatIsAPowerOfTwo) {
  const auto flow = example("tornado");
  const VorticityField plain(make_vector_field(flow)), scaled(make_vector_field(flow, 40, -7));
  std::mt19937_64 random(3);
  CellHint a, b;
  for (int i = 0; i < 100; ++i) {
    const Vec3 x = random_in(flow->bounds(), random);
    const Vec3 expected = plain.sample(x, a).value * 0x1p-47;
    EXPECT_EQ(scaled.sample(x * 0x1p40, b).value, expected);
  }
}

}  // namespace
}  // namespace palpate::test
