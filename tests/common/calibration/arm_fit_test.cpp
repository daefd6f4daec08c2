// An arm's kinematics: against a made arm whose true numbers are known.

#include "common/calibration/arm_fit.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/calibration/synthetic.h"

namespace palpate::test {
namespace {

double mean_of(const FitReport& report, const std::string& method, bool left_out) {
  const ErrorRow* row = report.find(method, "distance", left_out);
  return row ? row->errors.mean : NAN;
}

template <class Work>
std::string message_of(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
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
  // Plain squares cannot be relied on, which is said, and where to look.
  const std::string refused = message_of([&] { (void)calibrate_arm(table, arm.nominal, {}); });
  EXPECT_NE(refused.find("uncertain by up to"), std::string::npos) << refused;
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

// The stated uncertainty is that of fits to other noise, all over the workspace; what cannot be relied on is
// refused.
TEST(ArmFit, PredictsItsErrorOverTheWorkspaceAndRefusesALargeOne) {
  const SyntheticArm arm = synthetic_arm(1);
  const ArmFit good = calibrate_arm({"made", synthetic_arm_measurements(arm, true, 1)}, arm.nominal, {});
  const ErrorRow* const predicted = good.report.find("predicted", "distance", true);
  ASSERT_NE(predicted, nullptr);
  double squares = 0.0;
  std::size_t count = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    const ArmFit fit = calibrate_arm({"made", synthetic_arm_measurements(arm, true, seed)}, arm.nominal, {});
    for (const ArmMeasurement& row : synthetic_arm_measurements(arm, true, seed + 100)) {
      const double error = 1e3 * glm::distance(fit.chain.forward(row.readings).translation,
                                               arm.actual.forward(row.readings).translation);
      squares += error * error;
      ++count;
    }
  }
  const double rms = std::sqrt(squares / static_cast<double>(count));
  EXPECT_GT(predicted->errors.mean, 0.4 * rms);
  EXPECT_LT(predicted->errors.mean, 4.0 * rms);
  // The wrist hardly turned, on a patch of the plate: full of numbers that nothing tells apart.
  std::vector<ArmMeasurement> narrow = synthetic_arm_measurements(arm, true, 1);
  std::erase_if(narrow, [](const ArmMeasurement& row) { return row.grid != 0; });
  const std::vector<double> rest = narrow.front().readings;
  for (std::size_t i = 0; i < narrow.size(); ++i) {
    ArmMeasurement& row = narrow[i];
    for (std::size_t j = 0; j < rest.size(); ++j)
      row.readings[j] = rest[j] + 0.02 * std::sin(static_cast<double>((j + 2) * (i + 1)));
    const double n = static_cast<double>(i);
    row.point = arm.actual.forward(row.readings).translation +
                2e-4 * Vec3{std::sin(7.0 * n), std::cos(5.0 * n), std::sin(3.0 * n)};
  }
  const std::string refused = message_of([&] { (void)calibrate_arm({"arm.csv", narrow}, arm.nominal, {}); });
  EXPECT_NE(refused.find("condition number"), std::string::npos) << refused;
  EXPECT_NE(refused.find("in the workspace"), std::string::npos) << refused;
}

TEST(ArmFit, NamesSlipsOfUnits) {
  const SyntheticArm arm = synthetic_arm(3);
  const auto rows = synthetic_arm_measurements(arm, true, 3);
  for (const auto& [turn, length, words] :
       {std::tuple{1.0 / kDegree, 1.0, "readings look like degrees:"},
        std::tuple{1.0, 1000.0, "points look like millimetres"},
        std::tuple{1.0, 100.0, "points look like centimetres"},
        std::tuple{1.0 / kDegree, 1000.0, "degrees and the points like millimetres"}}) {
    auto slipped = rows;
    for (ArmMeasurement& row : slipped) {
      row.point *= length;
      for (double& reading : row.readings) reading *= turn;
    }
    const std::string line = message_of([&] { (void)calibrate_arm({"arm.csv", slipped}, arm.nominal, {}); });
    EXPECT_NE(line.find(words), std::string::npos) << line;
  }
}

// Readings of other points: nothing fits, and that is said.
TEST(ArmFit, FailsWhereItLeavesAsMuchAsThereWas) {
  const SyntheticArm arm = synthetic_arm(2);
  auto rows = synthetic_arm_measurements(arm, true, 2);
  for (ArmMeasurement& row : rows) row.grid = 0;
  std::vector<Vec3> points;
  for (const ArmMeasurement& row : rows) points.push_back(arm.nominal.forward(row.readings).translation);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    // 60 mm off the nominal arm, each to another side.
    const double t = 2.4 * static_cast<double>(i), z = std::cos(1.7 * static_cast<double>(i));
    rows[i].point = points[i] + 0.06 * Vec3{std::sqrt(1.0 - z * z) * std::cos(t),
                                            std::sqrt(1.0 - z * z) * std::sin(t), z};
  }
  const std::string line = message_of([&] {
    (void)calibrate_arm({"arm.csv", rows}, arm.nominal, {.offsets_only = true});
  });
  EXPECT_NE(line.find("leaves"), std::string::npos) << line;
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
