// Figure 6.7 in numbers: what the report says of chain, pipe and balance.

#include "lab/hand/chain/chain_rivals.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

const std::vector<RivalRun>& measured() {
  static const std::vector<RivalRun> runs = run_chain_rivals(nullptr);
  return runs;
}

const RivalRun& run_of(RivalMethod method, double angle) {
  for (const RivalRun& run : measured()) {
    if (run.method == method && run.angle == angle) return run;
  }
  ADD_FAILURE() << name_of(method) << " " << angle;
  return measured().front();
}

TEST(ChainRivals, TheChainKeepsBothConstraintsAndTellsTheDepth) {
  for (const double angle : kRivalAngles) {
    const RivalRun& run = run_of(RivalMethod::kChain, angle);
    EXPECT_LT(run.curve_drift, 1e-7) << angle;
    EXPECT_LT(run.surface_drift, 1e-9) << angle;
    EXPECT_LT(run.cue_error, 1e-7) << angle;
    // It lets go at the first step beyond the limit: steps are 0.1 mm.
    EXPECT_GT(run.release_depth, kDepthLimit) << angle;
    EXPECT_LT(run.release_depth, kDepthLimit + 1.2e-4) << angle;
    EXPECT_LT(run.drift_after, 1e-7) << "the same line goes on, " << angle;
  }
}

// The stretch of the pipe is the way along the curve: d / cos(angle) where it is straight.
TEST(ChainRivals, ThePipeLetsGoEarlyWhereTheyCrossAtASmallAngle) {
  double last = 1.0;
  for (const double angle : kRivalAngles) {
    const RivalRun& run = run_of(RivalMethod::kPipe, angle);
    EXPECT_LT(run.curve_drift, 1e-7) << angle;
    EXPECT_LT(run.surface_drift, 1e-7) << angle;
    EXPECT_GT(run.cue_error, 1e-3) << angle;
    EXPECT_LT(run.release_depth, last) << angle;
    EXPECT_NEAR(run.release_depth, kDepthLimit * std::cos(angle * std::numbers::pi / 180.0), 4e-4) << angle;
    last = run.release_depth;
  }
}

TEST(ChainRivals, TheBalanceLeavesOneConstraintOrTheOther) {
  for (const double angle : kRivalAngles) {
    EXPECT_GT(run_of(RivalMethod::kBalanceCurve, angle).surface_drift, 4e-3) << "through the surface";
    EXPECT_GT(run_of(RivalMethod::kBalanceCurve, angle).curve_drift, 1e-5) << "by Euler's steps";
    if (angle >= 50.0) {
      EXPECT_GT(run_of(RivalMethod::kBalanceSurface, angle).curve_drift, 2e-3) << "along the surface";
    }
  }
}

TEST(ChainRivals, TellsTheReport) {
  const ReportSection section = chain_rivals_section(measured());
  EXPECT_EQ(section.table.size(), measured().size());
  for (const auto& row : section.table) EXPECT_EQ(row.size(), section.columns.size());
  for (const RivalMethod method : kRivalMethods) {
    EXPECT_NE(section.plots.at(0).content.find(">" + std::string(name_of(method)) + "<"), std::string::npos);
  }
}

}  // namespace
}  // namespace palpate::test
