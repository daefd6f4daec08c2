// An arm's kinematics: against a made arm whose true numbers are known.

#include "common/calibration/arm_fit.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/calibration/synthetic_arm.h"

namespace palpate::test {
namespace {

double mean_of(const FitReport& report, const std::string& method, bool left_out) {
  const ErrorRow* row = report.find(method, "distance", left_out);
  return row ? row->errors.mean : NAN;
}

// Ikits 2006, sec. 4.3.3: 30 to 60 mm, about 10 mm with offsets, about 1 mm with the full model; a second
// grid nearly perpendicular to the first betters the condition number, and the advice for one grid asks for
// just that.
TEST(ArmFit, FollowsTheReferenceFromNominalToFull) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    SCOPED_TRACE(seed);
    const SyntheticArm arm = synthetic_arm(seed);
    const MeasurementTable<ArmMeasurement> both{"made", synthetic_arm_measurements(arm, true, seed)};
    const ArmFit fit = calibrate_arm(both, arm.nominal, {});
    EXPECT_GE(mean_of(fit.report, "nominal", false), 30.0);
    EXPECT_LE(mean_of(fit.report, "nominal", false), 60.0);
    EXPECT_GE(mean_of(fit.report, "offsets", true), 4.0);
    EXPECT_LE(mean_of(fit.report, "offsets", true), 16.0);
    EXPECT_LE(mean_of(fit.report, "full", true), 1.0);

    // Not only where it was measured: the wrist turned otherwise, the tip elsewhere.
    double worst = 0.0;
    for (const ArmMeasurement& row : synthetic_arm_measurements(arm, true, seed + 100)) {
      worst = std::max(worst, glm::distance(fit.chain.forward(row.readings).translation,
                                            arm.actual.forward(row.readings).translation));
    }
    EXPECT_LT(worst, 1.5e-3);

    std::vector<ArmMeasurement> one;
    for (const ArmMeasurement& row : both.rows) {
      if (row.grid == 0) one.push_back(row);
    }
    const ArmFit alone = calibrate_arm({"made", one}, arm.nominal, {});
    EXPECT_GT(alone.report.condition_number, fit.report.condition_number);
    EXPECT_GT(alone.report.condition_number, kReliableCondition);
    EXPECT_FALSE(alone.report.weak.empty());
    ASSERT_FALSE(alone.report.advice.empty());
    EXPECT_NE(alone.report.advice[0].find("nearly perpendicular"), std::string::npos);
  }
}

// Two offsets about one axis, with nothing between them: only their sum moves the tip.
TEST(ArmFit, RefusesParametersThatCannotBeToldApartAndNamesThem) {
  const SyntheticArm arm = synthetic_arm(1);
  DhhChain nominal = arm.nominal;
  nominal.rows[6].free[static_cast<std::size_t>(DhhQuantity::kGamma)] = true;
  nominal.rows[6].values[static_cast<std::size_t>(DhhQuantity::kAlpha)] = 180.0 * kDegree;
  try {
    (void)calibrate_arm({"arm.csv", synthetic_arm_measurements(arm, true, 1)}, nominal, {});
    FAIL() << "gamma6 and gamma7 turn about the same axis";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    const std::string line = error.what();
    EXPECT_NE(line.find("gamma6"), std::string::npos) << line;
    EXPECT_NE(line.find("gamma7"), std::string::npos) << line;
  }
}

TEST(ArmFit, RefusesTooFewMeasurementsAndGridsWithoutAPlane) {
  const SyntheticArm arm = synthetic_arm(1);
  auto rows = synthetic_arm_measurements(arm, true, 1);
  const auto refused = [&](const std::vector<ArmMeasurement>& part) -> std::string {
    try {
      (void)calibrate_arm({"arm.csv", part}, arm.nominal, {});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refused({rows.begin(), rows.begin() + 5}).find("5 measurements for 27 unknowns"),
            std::string::npos);
  while (rows.back().grid == 1 && rows[rows.size() - 3].grid == 1) rows.pop_back();
  EXPECT_NE(refused(rows).find("grid 1"), std::string::npos);
}

}  // namespace
}  // namespace palpate::test
