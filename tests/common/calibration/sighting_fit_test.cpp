// Tip of a stylus and position of the eyes.

#include "common/calibration/sighting_fit.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/calibration/synthetic.h"

namespace palpate::test {
namespace {

template <typename Work>
std::string refusal(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    return error.what();
  }
  return "";
}

TEST(Pivot, FindsTheTipWithinItsStatedDeviation) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto made = synthetic_pivot(seed);
    const PivotFit fit = calibrate_pivot({"made", made.rows}, {});
    for (int axis = 0; axis < 3; ++axis) {
      const double deviation = fit.report.parameters[static_cast<std::size_t>(axis)].deviation;
      EXPECT_LT(std::abs(fit.tip[axis] - made.truth.tip[axis]), 4.5 * deviation);
      EXPECT_LT(deviation, 0.5e-3);  // 0.5 mm of noise over 40 poses
    }
    EXPECT_LT(glm::distance(fit.pivot, made.truth.pivot), 1e-3);
    EXPECT_TRUE(fit.report.outliers.empty());
  }
}

TEST(Pivot, RobustLossFindsTheTipDespiteSlips) {
  auto made = synthetic_pivot(3);
  for (const std::size_t i : {4U, 17U, 30U}) made.rows[i].position += Vec3{0.09, -0.06, 0.04};
  const PivotFit robust = calibrate_pivot({"made", made.rows}, {.loss = Loss::kCauchy});
  const PivotFit plain = calibrate_pivot({"made", made.rows}, {});
  EXPECT_LT(glm::distance(robust.tip, made.truth.tip), 0.6e-3);
  EXPECT_GT(glm::distance(plain.tip, made.truth.tip), 1.5e-3);
  EXPECT_EQ(robust.report.outliers, (std::vector<std::size_t>{5, 18, 31}));
}

// Turning about one axis leaves the tip's place along it open.
TEST(Pivot, RefusesTurnsAboutOneAxis) {
  auto made = synthetic_pivot(2);
  for (std::size_t i = 0; i < made.rows.size(); ++i) {
    const Quat q = rotation_by({0.0, 0.0, 0.1 * static_cast<double>(i)});
    made.rows[i] = {made.truth.pivot - q * made.truth.tip, q};
  }
  EXPECT_NE(refusal([&] {
              (void)calibrate_pivot({"turned.csv", made.rows}, {});
            }).find("tilt the stylus"),
            std::string::npos);
  made.rows.resize(2);
  EXPECT_NE(refusal([&] {
              (void)calibrate_pivot({"few.csv", made.rows}, {});
            }).find("4 at least"),
            std::string::npos);
}

TEST(Eyes, AreFoundToAMillimetreAndTheirSeparationWithThem) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto made = synthetic_sightings(seed);
    const EyeFit fit = calibrate_eyes({"made", made.rows}, {});
    ASSERT_TRUE(fit.left && fit.right && fit.separation);
    EXPECT_LT(glm::distance(*fit.left, made.truth.left), 1.5e-3);
    EXPECT_LT(glm::distance(*fit.right, made.truth.right), 1.5e-3);
    EXPECT_NEAR(*fit.separation, glm::distance(made.truth.left, made.truth.right), 1.5e-3);
    EXPECT_TRUE(fit.report.advice.empty());
  }
}

TEST(Eyes, RobustLossFindsThemDespiteSlipsAndTheReportNamesTheRows) {
  auto made = synthetic_sightings(4);
  for (const std::size_t i : {5U, 20U}) made.rows[i].head.position += Vec3{0.05, -0.06, 0.0};
  const EyeFit robust = calibrate_eyes({"made", made.rows}, {.loss = Loss::kCauchy});
  const EyeFit plain = calibrate_eyes({"made", made.rows}, {});
  ASSERT_TRUE(robust.left && robust.right && plain.left && plain.right);
  const auto off = [&](const EyeFit& fit) {
    return std::max(glm::distance(*fit.left, made.truth.left), glm::distance(*fit.right, made.truth.right));
  };
  EXPECT_LT(off(robust), 1.5e-3);
  EXPECT_GT(off(plain), 3e-3);
  EXPECT_EQ(robust.report.outliers, (std::vector<std::size_t>{6, 21}));
  for (const FittedParameter& p : robust.report.parameters) EXPECT_LT(p.deviation, 1e-3);
}

// A head that does not turn sights along one line: how far back the eye lies stays open.
TEST(Eyes, RefuseSightingsAlongOneLine) {
  auto made = synthetic_sightings(1);
  for (SightingMeasurement& row : made.rows) {
    row.head = {{0.0, 0.6, 0.7}, identity_rotation()};
    const Vec3 eye = row.head.position;
    row.near = eye + Vec3{0.0, 0.0, -0.3};
    row.far = eye + Vec3{0.0, 0.0, -0.9};
  }
  EXPECT_NE(refusal([&] {
              (void)calibrate_eyes({"still.csv", made.rows}, {});
            }).find("turn the head"),
            std::string::npos);
}

}  // namespace
}  // namespace palpate::test
