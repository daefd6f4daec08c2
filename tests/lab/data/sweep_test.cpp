#include "lab/data/sweep.h"

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "lab/data/made_data.h"

namespace palpate::test {
namespace {

Vec3 swirl(const Vec3& x) { return {-x.y + 0.3, x.x, 0.4 + 0.1 * x.x * x.y}; }

std::shared_ptr<const VectorField> field_of(const DataSet& data) {
  return make_vector_field({data}, VectorChoice{.arrays = {"velocity"}, .label = "velocity"}, "made");
}

Sweep quick_sweep(const VectorField& field) {
  SweepRequest request{.subject = "made", .effort = Effort::kQuick};
  for (int i = 0; i < 6; ++i) request.seeds.push_back({-0.513 + 0.149 * i, 0.107 * i, -0.81});
  request.seeds.push_back({99.0, 0.0, 0.0});
  return run_sweep(field, request, nullptr);
}

void expect_converging(const Sweep& sweep) {
  EXPECT_EQ(sweep.seeds, 7U);
  EXPECT_EQ(sweep.seeds_outside, 1U);
  EXPECT_LT(sweep.agreement.p95, 1e-7);
  for (const char* method : {"euler", "rk4", "bs32", "rk34", "dp54", "rodas4"}) {
    double loosest = 0.0;
    double tightest = 1.0;
    for (const SweepRow& row : sweep.rows) {
      if (row.method != method) continue;
      EXPECT_EQ(row.error.judged + row.error.inside, sweep.reference_lines.size()) << method << row.parameter;
      EXPECT_EQ(row.error.lines.size(), sweep.reference_lines.size());
      EXPECT_GT(row.seconds, 0.0);
      if (loosest == 0.0) loosest = row.error.p95;
      tightest = row.error.p95;
    }
    EXPECT_LT(tightest, 0.2 * loosest) << method;
  }
}

TEST(Sweep, ConvergesWithEveryMethodOnTrilinearData) {
  expect_converging(quick_sweep(*field_of(uniform_data(9, {Vec3(-1.0), Vec3(1.0)}, swirl))));
}

TEST(Sweep, HasTheExactMethodAsReferenceOnTetrahedra) {
  const auto even = even_coordinates(6);
  const Sweep sweep = quick_sweep(*field_of(tetrahedral_data(even, even, even, swirl)));
  expect_converging(sweep);
  EXPECT_EQ(sweep.reference, "exact");
  EXPECT_EQ(sweep.rows.front().method, "exact");
  // By the other one, which differs by a little.
  EXPECT_EQ(sweep.rows.front().judge, sweep.second);
  EXPECT_GT(sweep.rows.front().error.max, 0.0);
  EXPECT_EQ(sweep.disputed, 0U);
}

TEST(Sweep, SaysWhyThereIsNothingToCompare) {
  const auto field = field_of(uniform_data(5, {Vec3(-1.0), Vec3(1.0)}, [](const Vec3& x) { return -x; }));
  EXPECT_THROW((void)run_sweep(*field, {.seeds = {{0.5, 0.5, 0.5}}, .effort = Effort::kQuick}, nullptr),
               Error);
  EXPECT_THROW((void)run_sweep(*field, {.seeds = {{9.0, 0.5, 0.5}}, .effort = Effort::kQuick}, nullptr),
               Error);
}

}  // namespace
}  // namespace palpate::test
