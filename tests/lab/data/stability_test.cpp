#include "lab/data/stability.h"

#include <gtest/gtest.h>

#include "lab/data/made_data.h"

namespace palpate::test {
namespace {

Vec3 swirl(const Vec3& x) { return {-x.y + 0.3, x.x, 0.4 + 0.1 * x.x * x.y}; }

StabilityRequest request_for(const DataSet& data) {
  StabilityRequest request{
      .blocks = {data}, .choice = VectorChoice{.arrays = {"velocity"}, .label = "velocity"}, .file = "made"};
  for (int i = 0; i < 8; ++i) request.seeds.push_back({-0.6 + 0.15 * i, 0.05 * i, -0.7});
  return request;
}

void expect_all_hold(const std::vector<StabilityCase>& cases) {
  EXPECT_EQ(cases.size(), 7U);
  for (const StabilityCase& c : cases) EXPECT_TRUE(c.row.holds) << c.row.name << ": " << c.row.measured;
}

TEST(Stability, HoldsOnTrilinearData) {
  expect_all_hold(run_stability(request_for(uniform_data(9, {Vec3(-1.0), Vec3(1.0)}, swirl)), nullptr));
}

TEST(Stability, HoldsOnTetrahedra) {
  const auto even = even_coordinates(6);
  expect_all_hold(run_stability(request_for(tetrahedral_data(even, even, even, swirl)), nullptr));
}

// A row must be able to fail: against lines of a tolerance that rounding cannot meet, the same data does not
// hold.
TEST(Stability, FailsWhereTheLimitCannotBeMet) {
  StabilityRequest request = request_for(uniform_data(9, {Vec3(-1.0), Vec3(1.0)}, swirl));
  request.trace.tolerance = 1e-17;
  request.trace.integrator = Integrator::kBs32;
  request.trace.max_steps = 2000;
  bool any_fails = false;
  for (const StabilityCase& c : run_stability(request, nullptr)) any_fails = any_fails || !c.row.holds;
  EXPECT_TRUE(any_fails);
}

}  // namespace
}  // namespace palpate::test
