// Older estimates of depth are seen to be wrong, and how; the proxy is not.

#include "lab/hand/constraint/surface_depth.h"

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

const SurfaceDepth& measured() {
  static const SurfaceDepth depth = run_surface_depth(nullptr);
  return depth;
}

std::vector<double> errors_of(const std::vector<SurfaceDepthRow>& rows, DepthMethod method) {
  std::vector<double> errors;
  for (const SurfaceDepthRow& row : rows) {
    if (row.method == method) errors.push_back(row.error);
  }
  return errors;
}

TEST(SurfaceDepth, OfTheProxyIsExact) {
  for (const auto* rows : {&measured().by_time, &measured().by_size}) {
    for (const double error : errors_of(*rows, DepthMethod::kProxy)) EXPECT_LT(error, 1e-9);
  }
}

TEST(SurfaceDepth, ByPathDriftsWithTime) {
  const auto errors = errors_of(measured().by_time, DepthMethod::kByPath);
  ASSERT_EQ(errors.size(), 8U);
  EXPECT_GT(errors.back(), 4.0 * errors[4]);
  EXPECT_GT(errors.back(), 0.1 * kMeanDepth);
}

// The slope on the surface is 2 at the tip where the hand enters and up to 4 elsewhere: by value, a depth is
// overstated by up to as much, at small curvature as well.
TEST(SurfaceDepth, ByValueIsWrongWhereTheSlopeIsAnother) {
  const auto by_time = errors_of(measured().by_time, DepthMethod::kByValue);
  EXPECT_NEAR(by_time.back(), by_time[4], 0.6 * by_time[4]) << "no drift";
  for (const double error : errors_of(measured().by_size, DepthMethod::kByValue)) {
    EXPECT_GT(error, 0.05 * kMeanDepth);
  }
}

TEST(SurfaceDepth, TellsTheReport) {
  const ReportSection section = surface_depth_section(measured());
  EXPECT_EQ(section.table.size(), measured().by_time.size() + measured().by_size.size());
  EXPECT_EQ(section.plots.size(), 2U);
}

}  // namespace
}  // namespace palpate::test
