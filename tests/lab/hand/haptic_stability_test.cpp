#include "lab/hand/haptic_stability.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "lab/data/made_data.h"

namespace palpate::test {
namespace {

Vec3 swirl(const Vec3& x) { return {-x.y + 0.3, x.x, 0.4 + 0.1 * x.x * x.y}; }

StabilityRequest request_for(const DataSet& data) {
  StabilityRequest request{
      .blocks = {data}, .choice = VectorChoice{.arrays = {"velocity"}, .label = "velocity"}, .file = "made"};
  request.trace.threads = 1;
  for (int i = 0; i < 4; ++i) request.seeds.push_back({-0.6 + 0.3 * i, 0.1 * i, -0.3});
  return request;
}

std::vector<StabilityCase> cases_of(const StabilityRequest& request, const ConstraintSweep& sweep) {
  const auto field = make_vector_field(request.blocks, request.choice, request.file);
  return run_haptic_stability(field, sweep, request, nullptr);
}

ConstraintSweep sweep_with(double farthest) {
  ConstraintSweep sweep;
  sweep.rows.push_back({.residual = {.max = farthest}, .compared = 100});
  return sweep;
}

void expect_all_hold(const std::vector<StabilityCase>& cases) {
  EXPECT_EQ(cases.size(), 17U);
  for (const StabilityCase& c : cases) EXPECT_TRUE(c.row.holds) << c.row.name << ": " << c.row.measured;
  // Measured, not assumed: forces are felt, and grow as fast as they may.
  const auto measured = [&](const std::string& name) {
    const auto found =
        std::find_if(cases.begin(), cases.end(), [&](const StabilityCase& c) { return c.row.name == name; });
    return found == cases.end() ? -1.0 : found->row.measured;
  };
  EXPECT_GT(measured("hand on this data: force"), 0.99);
  EXPECT_GT(measured("hand at a sink: slew"), 0.9);
  EXPECT_GT(measured("hand on this data: residual"), 0.0);
}

TEST(HapticStability, HoldsOnTrilinearData) {
  expect_all_hold(cases_of(request_for(uniform_data(9, {Vec3(-1.0), Vec3(1.0)}, swirl)), sweep_with(1e-8)));
}

TEST(HapticStability, HoldsOnTetrahedra) {
  const auto even = even_coordinates(6);
  expect_all_hold(cases_of(request_for(tetrahedral_data(even, even, even, swirl)), sweep_with(1e-8)));
}

TEST(HapticStability, FailsWhereAProxyLeftItsLine) {
  const auto even = even_coordinates(4);
  const auto cases = cases_of(request_for(tetrahedral_data(even, even, even, swirl)), sweep_with(2e-6));
  EXPECT_EQ(cases.front().row.name, "hand: on its line");
  EXPECT_FALSE(cases.front().row.holds);
}

}  // namespace
}  // namespace palpate::test
