// An arm's kinematics: against a made arm whose true numbers are known.

#include "common/calibration/arm_fit.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/calibration/synthetic.h"

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

// Nine points that a hand put wrong by some centimetres: a robust loss finds the arm as if they were not
// there, names them, and does not take its uncertainty from them.
TEST(ArmFit, RobustLossesFindTheArmDespitePointsThatWerePutWrong) {
  const SyntheticArm arm = synthetic_arm(2);
  MeasurementTable<ArmMeasurement> table{"made", synthetic_arm_measurements(arm, true, 2)};
  const ArmFit clean = calibrate_arm(table, arm.nominal, {});
  std::vector<std::size_t> wrong;
  for (std::size_t i = 3; i < table.rows.size(); i += 6) {
    table.rows[i].point += Vec3{0.04, i % 2 == 0 ? -0.03 : 0.03, 0.02};
    wrong.push_back(i + 1);
  }
  ASSERT_EQ(wrong.size(), 9U);
  const auto worst_of = [&](const ArmFit& fit) {
    double worst = 0.0;
    for (const ArmMeasurement& row : synthetic_arm_measurements(arm, true, 102))
      worst = std::max(worst, glm::distance(fit.chain.forward(row.readings).translation,
                                            arm.actual.forward(row.readings).translation));
    return worst;
  };
  EXPECT_GT(worst_of(calibrate_arm(table, arm.nominal, {})), 5e-3);
  for (const Loss loss : {Loss::kHuber, Loss::kCauchy}) {
    const ArmFit robust = calibrate_arm(table, arm.nominal, {.loss = loss});
    // Huber's pull never ends: it leaves a few tenths of a millimetre.
    EXPECT_LT(worst_of(robust), loss == Loss::kHuber ? 3e-3 : 1.6e-3);
    EXPECT_EQ(robust.report.outliers, wrong);
    ASSERT_EQ(robust.report.parameters.size(), clean.report.parameters.size());
    for (std::size_t p = 0; p < clean.report.parameters.size(); ++p)
      EXPECT_LT(robust.report.parameters[p].deviation, 3.0 * clean.report.parameters[p].deviation);
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
