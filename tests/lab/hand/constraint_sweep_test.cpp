// The sweep of the constraint's budget on a rotation, whose streamlines are circles: what the report calls
// reference is held against those.

#include "lab/hand/constraint/constraint_sweep.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "lab/data/made_data.h"
#include "lab/hand/constraint/reference_curve.h"
#include "lab/hand/streamline_run.h"

namespace palpate::test {
namespace {

std::shared_ptr<const VectorField> made(const DataSet& data) {
  return make_vector_field({data}, VectorChoice{.arrays = {"velocity"}, .label = "velocity"}, "made");
}

std::shared_ptr<const VectorField> rotation() {
  const auto even = even_coordinates(9);
  return made(tetrahedral_data(even, even, even, [](const Vec3& x) { return Vec3{-x.y, x.x, 0.0}; }));
}

Vec3 on_circle(double angle) { return {0.5 * std::cos(angle), 0.5 * std::sin(angle), 0.1}; }

TEST(ReferenceCurve, IsTheCircleAndFindsItsLocalMinimum) {
  const auto field = rotation();
  const ReferenceCurve curve(*field, on_circle(0.0), 1.2);
  ASSERT_FALSE(curve.empty());
  std::size_t from = curve.seed();
  for (const double angle : {0.3, 1.0, 2.0, 1.2, -0.4, -1.5}) {
    // Off the circle along its radius and its axis: the nearest point is known.
    const Vec3 probe = on_circle(angle) * Vec3{1.3, 1.3, 1.0} + Vec3{0.0, 0.0, 0.07};
    const auto place = curve.nearest(probe, from);
    from = place.point;
    EXPECT_LT(glm::distance(place.position, on_circle(angle)), 1e-8) << angle;
    EXPECT_NEAR(place.arc, 0.5 * angle, 1e-7) << angle;
    EXPECT_FALSE(place.beyond);
  }
  EXPECT_TRUE(curve.nearest(on_circle(2.5), from).beyond) << "cut off at arc 1.2, an angle of 2.4";
  EXPECT_TRUE(ReferenceCurve(*field, {3.0, 0.0, 0.0}, 1.2).empty());
}

ConstraintSweep sweep_of(const std::shared_ptr<const VectorField>& field) {
  return run_constraint_sweep(
      field, {.subject = "made", .seeds = {on_circle(0.0), on_circle(2.0)}, .effort = Effort::kQuick},
      nullptr);
}

const ConstraintRow& row_of(const ConstraintSweep& sweep, PathKind path, const std::string& parameter) {
  const auto found = std::find_if(sweep.rows.begin(), sweep.rows.end(), [&](const ConstraintRow& row) {
    return row.path == path && row.parameter() == parameter;
  });
  EXPECT_NE(found, sweep.rows.end());
  return *found;
}

TEST(ConstraintSweep, SeesTheErrorsThatASmallBudgetMakes) {
  const ConstraintSweep sweep = sweep_of(rotation());
  EXPECT_EQ(sweep.seeds, 2U);
  EXPECT_DOUBLE_EQ(sweep.release_force, 2.0);  // 200 N/m times 10 mm
  for (const PathKind kind : kPathKinds) {
    const ConstraintRow& full = row_of(sweep, kind, "iterations=64");
    EXPECT_EQ(full.steps, 1600U);
    EXPECT_GT(full.compared, full.steps / 3) << name_of(kind);
    EXPECT_LE(full.residual.max, 1e-6) << name_of(kind);
    EXPECT_LE(full.force_error.p99, 1e-3) << name_of(kind);
    EXPECT_GT(full.us_mean, 0.0);
    // Out of iterations the proxy lags behind, but stays on the line.
    const ConstraintRow& one = row_of(sweep, kind, "iterations=1");
    EXPECT_GT(one.force_error.max, 10.0 * full.force_error.median) << name_of(kind);
    EXPECT_LE(one.residual.max, 1e-6) << name_of(kind);
    EXPECT_GT(one.fallbacks, full.fallbacks) << name_of(kind);
  }
  const auto rows = work_precision_rows(sweep);
  EXPECT_EQ(rows.size(), 5 * sweep.rows.size());
  EXPECT_EQ(rows[0].method, "streamline");
  EXPECT_EQ(rows[0].parameter, "iterations=1");
}

}  // namespace
}  // namespace palpate::test
