// vtkStreamTracer as a peer: its lines on the same mesh, and where there are none.

#include "lab/peer/vtk_tracer.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/files/find_helper.h"
#include "lab/data/made_data.h"
#include "lab/data/sweep.h"

namespace palpate::test {
namespace {

// A circle by its points and tangents every 10 degrees: arc lengths and places in between are right to the fourth order.
TEST(AtEqualArcs, FollowsACircle) {
  constexpr double kRadius = 2.0, kSpacing = 0.25;
  std::vector<Vec3> points, tangents;
  for (int i = 0; i <= 18; ++i) {
    const double a = i * std::numbers::pi / 18.0;
    points.push_back({kRadius * std::cos(a), kRadius * std::sin(a), 0.0});
    tangents.push_back(3.0 * Vec3{-std::sin(a), std::cos(a), 0.0});
  }
  const std::vector<LinePoint> line = at_equal_arcs(points, tangents, kSpacing);
  ASSERT_EQ(line.size(), 27U);  // the seed, 25 multiples, the end
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const double s = kSpacing * static_cast<double>(k);
    EXPECT_DOUBLE_EQ(line[k].arc, s);
    EXPECT_LT(glm::distance(line[k].position,
                            {kRadius * std::cos(s / kRadius), kRadius * std::sin(s / kRadius), 0.0}),
              2e-5);
    EXPECT_NEAR(line[k].speed, 3.0, 1e-12);
    EXPECT_TRUE(std::isnan(line[k].error));
  }
  EXPECT_NEAR(line.back().arc, kRadius * std::numbers::pi, 2e-5);
}

class VtkPeer : public testing::Test {
 protected:
  void SetUp() override {
    if (find_helper(kVtkTracerProgram).empty()) GTEST_SKIP() << kVtkTracerProgram << " is not built";
  }
  void TearDown() override { ::unsetenv("PALPATE_HELPERS"); }
};

std::shared_ptr<const VectorField> field_of(const DataSet& data) {
  return make_vector_field({data}, VectorChoice{.arrays = {"velocity"}, .label = "velocity"}, "made");
}
Vec3 swirl(const Vec3& x) { return {-x.y + 0.3, x.x, 0.4 + 0.1 * x.x * x.y}; }

Sweep sweep_of(const VectorField& field, bool backward = false) {
  SweepRequest request{.subject = "made", .effort = Effort::kQuick};
  request.trace.backward = backward;
  for (int i = 0; i < 6; ++i) request.seeds.push_back({-0.513 + 0.149 * i, 0.107 * i, -0.31});
  return run_sweep(field, request, nullptr);
}

/// Every line judged, none failed, and errors that fall with the step, below `least`.
void expect_converging(const Sweep& sweep, double least) {
  EXPECT_EQ(sweep.peer_missing, "");
  for (const std::string method : {"VTK rk4", "VTK rk45"}) {
    double loosest = 0.0, tightest = 1.0;
    for (const SweepRow& row : sweep.rows) {
      if (row.method != method) continue;
      EXPECT_EQ(row.error.judged, sweep.reference_lines.size()) << method << row.parameter;
      EXPECT_EQ(row.error.failed(), 0U) << method << row.parameter;
      EXPECT_TRUE(std::isnan(row.error.covered)) << "it states nothing";
      EXPECT_EQ(row.judge, sweep.reference);
      if (loosest == 0.0) loosest = row.error.p95;
      tightest = std::min(tightest, row.error.p95);
    }
    EXPECT_GT(loosest, 10.0 * tightest) << method;
    EXPECT_LT(tightest, least) << method;
  }
}

TEST_F(VtkPeer, TracesTheLinesOfTetrahedra) {
  const auto even = even_coordinates(6);
  expect_converging(sweep_of(*field_of(tetrahedral_data(even, even, even, swirl))), 1e-4);
}

TEST_F(VtkPeer, TracesTheLinesOfAnImage) {
  expect_converging(sweep_of(*field_of(uniform_data(9, {Vec3(-1.0), Vec3(1.0)}, swirl)), true), 1e-5);
}

TEST_F(VtkPeer, TracesTheLinesOfARectilinearGrid) {
  const std::vector<double> uneven{-1.0, -0.7, -0.5, -0.1, 0.2, 0.6, 1.0};
  expect_converging(sweep_of(*field_of(rectilinear_data(uneven, uneven, uneven, swirl))), 1e-5);
}

TEST_F(VtkPeer, IsLeftOutWithAWordWhereItsHelperIsNotThere) {
  ::setenv("PALPATE_HELPERS", "/nowhere", 1);
  const Sweep sweep = sweep_of(*field_of(uniform_data(5, {Vec3(-1.0), Vec3(1.0)}, swirl)));
  EXPECT_NE(sweep.peer_missing.find("palpate-vtk-tracer, is not installed"), std::string::npos);
  EXPECT_TRUE(
      std::ranges::none_of(sweep.rows, [](const SweepRow& row) { return row.method.starts_with("VTK"); }));
}

}  // namespace
}  // namespace palpate::test
