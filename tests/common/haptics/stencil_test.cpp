// Derivatives by differences, and the measures that rest on them: exact on quadratics, and without leaps on
// tetrahedra, where the gradient of the interpolant leaps from cell to cell.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/haptics/measure.h"
#include "tests/common/haptics/formula_scalars.h"
#include "tests/common/trace/linear_fields.h"

namespace palpate {
namespace {

using test::rows;

TEST(Stencil, IsExactOnQuadratics) {
  const auto field = test::scalars<test::Mixed>();
  const double spacing = stencil_spacing(*field);
  EXPECT_EQ(spacing, field->diagonal() / 1024.0);
  CellHint hint;
  const Vec3 x{0.3, -0.2, 0.7};
  Jet3 jet;
  ASSERT_EQ(difference_jet(*field, x, spacing, hint, jet), SampleStatus::kOk);
  const Jet3 exact = field->analytic()->jet(x);
  EXPECT_NEAR(jet.value, exact.value, 1e-15);
  EXPECT_LE(glm::distance(jet.gradient, exact.gradient), 1e-12);
  for (int a = 0; a < 3; ++a) EXPECT_LE(glm::distance(jet.hessian[a], exact.hessian[a]), 1e-10);
  EXPECT_LE(glm::distance(difference_gradient(*field, x, spacing, hint).value, exact.gradient), 1e-12);
}

TEST(Stencil, SaysWhereOneOfItsValuesIsMissing) {
  const auto field = test::scalars<test::Mixed>();
  CellHint hint;
  Jet3 jet;
  EXPECT_EQ(difference_gradient(*field, {3.99, 0.0, 0.0}, 0.1, hint).status, SampleStatus::kOutside);
  EXPECT_EQ(difference_jet(*field, {0.0, 0.0, -3.99}, 0.1, hint, jet), SampleStatus::kOutside);
  EXPECT_EQ(jet.gradient, Vec3{0.0});
}

TEST(Stencil, DoesNotLeapFromCellToCell) {
  // The speed of a rotation, 2 r, on random tetrahedra of edges of 0.25.
  const auto flow = test::on_tetrahedra(rows(0, -2, 0, 2, 0, 0, 0, 0, 0), Vec3{0.0}, 9, 0.2, 1);
  const auto field = make_speed_field(flow);
  const double spacing = stencil_spacing(*field);
  EXPECT_NEAR(spacing, 2.0 / 9.0, 1e-12);
  CellHint hint;
  constexpr double kStep = 1e-4;
  const auto at = [](int n) {
    return Vec3{0.1 + 0.6 * kStep * n, -0.3 + 0.5 * kStep * n, 0.2 - 0.3 * kStep * n};
  };
  VectorSample raw = field->gradient(at(0), hint), smooth = difference_gradient(*field, at(0), spacing, hint);
  double raw_leap = 0.0, leap = 0.0, steepest = 0.0;
  for (int n = 1; n < 5000; ++n) {
    const VectorSample next_raw = field->gradient(at(n), hint);
    const VectorSample next = difference_gradient(*field, at(n), spacing, hint);
    ASSERT_EQ(next.status, SampleStatus::kOk);
    raw_leap = std::max(raw_leap, glm::distance(next_raw.value, raw.value));
    leap = std::max(leap, glm::distance(next.value, smooth.value));
    steepest = std::max(steepest, glm::length(next_raw.value));
    raw = next_raw;
    smooth = next;
  }
  // Each of six values changes by no more than the steepest slope times the step.
  EXPECT_LE(leap, std::sqrt(3.0) * 2.0 * steepest * kStep / spacing);
  EXPECT_GT(raw_leap, 50.0 * leap) << "what it is good for";
}

TEST(Measure, IsThatOfTheDataAtAPointOfTheWorkspace) {
  // Shown at 0.01 m a unit: the workspace point (0.003, 0.004, 0) is (0.3, 0.4, 0) of the data.
  const auto cylinder = test::scalars<test::Cylinder>();
  const Workspace workspace(0.01, cylinder->frame());
  const Vec3 x{0.003, 0.004, 0.0};
  EXPECT_NEAR(ValueMeasure(cylinder, workspace).at(x).value, 0.25, 1e-15);
  EXPECT_NEAR(GradientMeasure(cylinder, workspace).at(x).value, 1.0, 1e-12);
  EXPECT_EQ(GradientMeasure(cylinder, workspace).at(Vec3{1.0}).status, SampleStatus::kOutside);
  const auto flow = test::on_tetrahedra(rows(0, -2, 0, 2, 0, 0, 0, 0, 0), Vec3{0.0}, 9, 0.2, 1);
  EXPECT_NEAR(SpeedMeasure(flow, Workspace(0.01, flow->frame())).at(x).value, 1.0, 1e-12);
  EXPECT_EQ(SpeedMeasure(flow, Workspace(0.01, flow->frame())).at(Vec3{1.0}).status, SampleStatus::kOutside);
}

}  // namespace
}  // namespace palpate
