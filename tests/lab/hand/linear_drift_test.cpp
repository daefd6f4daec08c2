// Drift of the linear model: of the first order in the speed, as Euler's rule, and of known size on a circle.

#include "lab/hand/constraint/linear_drift.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

const LinearDrift& measured() {
  static const LinearDrift drift = run_linear_drift(nullptr);
  return drift;
}

double drift_at(DriftFlow flow, FollowMethod method, double speed) {
  for (const LinearDriftRow& row : measured().by_speed) {
    if (row.flow == flow && row.method == method && row.speed == speed) return row.drift;
  }
  return -1.0;
}

// On a circle of curvature q a proxy on the tangent at arc step h is h^2 q / 2 farther out after each step,
// so that after the way L it has drifted by q L h / 2.
TEST(LinearDrift, IsEulersOnACircle) {
  for (const double speed : {0.01, 0.1, 0.5}) {
    const double h = speed * 1e-3;
    EXPECT_NEAR(drift_at(DriftFlow::kTurning, FollowMethod::kLinearStep, speed),
                0.5 * kDriftRate * kDriftWay * h, 0.05 * 0.5 * kDriftRate * kDriftWay * h)
        << speed;
  }
}

TEST(LinearDrift, GrowsWithSpeedAndDivergence) {
  const double slow = drift_at(DriftFlow::kParting, FollowMethod::kLinearStep, 0.1);
  const double fast = drift_at(DriftFlow::kParting, FollowMethod::kLinearStep, 0.2);
  EXPECT_NEAR(fast / slow, 2.0, 0.1) << "first order";
  double last = 0.0;
  for (const LinearDriftRow& row : measured().by_rate) {
    if (row.flow != DriftFlow::kParting || row.method != FollowMethod::kLinearStep) continue;
    EXPECT_GT(row.drift, last) << row.rate;
    EXPECT_LT(row.drift, 0.1) << "held all the way";
    last = row.drift;
  }
}

TEST(LinearDrift, IsNoneOnTheStreamlineItself) {
  for (const auto* rows : {&measured().by_speed, &measured().by_rate}) {
    for (const LinearDriftRow& row : *rows) {
      if (row.method == FollowMethod::kStreamline) {
        EXPECT_LT(row.drift, 1e-6) << name_of(row.flow) << " " << row.speed << " " << row.rate;
      }
    }
  }
  EXPECT_GT(drift_at(DriftFlow::kParting, FollowMethod::kLinearSettled, 0.2), 1e-4);
}

TEST(LinearDrift, TellsTheReport) {
  const ReportSection section = linear_drift_section(measured());
  EXPECT_EQ(section.plots.size(), 2U);
  EXPECT_EQ(section.table.size(), 6U) << "two flows, three methods";
  for (const auto& row : section.table) EXPECT_EQ(row.size(), section.columns.size());
  EXPECT_EQ(section.work_precision.size(), measured().by_speed.size() + measured().by_rate.size());
}

}  // namespace
}  // namespace palpate::test
