// The solver and the analysis of what measurements can tell apart.

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/calibration/fit_report.h"
#include "common/math/quaternion.h"

namespace palpate::test {
namespace {

Vec3 random_vector(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random), z = normal(random);
  return {x, y, z};
}

LeastSquaresProblem rotation_problem(const Quat& truth, const Quat& start, std::size_t outliers) {
  LeastSquaresProblem problem;
  problem.parameters = {
      {.values = {start.w, start.x, start.y, start.z}, .names = {"1", "2", "3"}, .quaternion = true}};
  std::mt19937 random{2};
  for (std::size_t i = 0; i < 30; ++i) {
    const Vec3 from = random_vector(random);
    const Vec3 to = i < outliers ? 3.0 * random_vector(random) : truth * from;
    problem.residuals.push_back(
        {.parameters = {0}, .dimension = 3, .evaluate = [from, to](const double* const* x, double* r) {
           const Quat q = glm::normalize(Quat{x[0][0], x[0][1], x[0][2], x[0][3]});
           const Vec3 left = q * from - to;
           for (int axis = 0; axis < 3; ++axis) r[axis] = left[axis];
         }});
  }
  return problem;
}

double angle_to(const LeastSquaresProblem& problem, const Quat& truth) {
  const auto& v = problem.parameters[0].values;
  return angle_of(Quat{v[0], v[1], v[2], v[3]} * glm::conjugate(truth));
}

// Rotations whose largest component is each of the four, and starts far off: the choice of components changes
// on the way.
TEST(LeastSquares, FindsRotationsWhicheverComponentIsLargest) {
  for (const Quat& truth : {Quat{1, 0.1, 0.2, 0.1}, Quat{0.1, 1, 0.2, 0.1}, Quat{0.1, -0.1, 1, 0.2},
                            Quat{0.1, 0.3, -0.2, 1}, Quat{0.5, 0.5, 0.5, 0.5}}) {
    LeastSquaresProblem problem =
        rotation_problem(glm::normalize(truth), rotation_by({0.9, -1.0, 0.8}) * glm::normalize(truth), 0);
    const LeastSquaresSummary summary = minimize(problem, {});
    EXPECT_LT(angle_to(problem, glm::normalize(truth)), 1e-7) << summary.message;
  }
}

TEST(LeastSquares, RobustLossWithstandsOutliers) {
  const Quat truth = glm::normalize(Quat{0.4, 0.3, -0.2, 0.7});
  LeastSquaresProblem plain = rotation_problem(truth, identity_rotation(), 6), robust = plain;
  minimize(plain, {});
  minimize(robust, {.loss = Loss::kCauchy, .loss_scale = 0.05});
  EXPECT_GT(angle_to(plain, truth), 0.05);
  EXPECT_LT(angle_to(robust, truth), 0.005);
}

// A x with known singular values; columns of different units must not count as weakness.
TEST(Identifiability, ScalesColumnsAndNamesWhatCannotBeToldApart) {
  Linearization lin{.rows = 4,
                    .columns = 3,
                    .jacobian = {1, 0, 0,       //
                                 0, 1000, 1e3,  //
                                 0, 1000, 1e3,  //
                                 0, 0, 0.001},  //
                    .residuals = {},
                    .names = {"a", "b", "c"}};
  const Identifiability found = analyze(lin);
  EXPECT_GT(found.condition_number, 1e6);
  ASSERT_EQ(found.weak.size(), 1U);
  ASSERT_EQ(found.weak[0].parts.size(), 2U);
  const std::string words = described(found.weak[0]);
  EXPECT_NE(words.find('b'), std::string::npos);
  EXPECT_NE(words.find('c'), std::string::npos);
  EXPECT_EQ(words.find('a'), std::string::npos);

  lin.jacobian = {1, 0, 0, 0, 1000, 0, 0, 0, 1e-6, 0, 0, 0};
  EXPECT_NEAR(analyze(lin).condition_number, 1.0, 1e-12);
  EXPECT_NEAR(analyze(lin).raw_condition_number, 1e9, 1.0);
  // A measurement a row of deviation one: each parameter's deviation is the inverse of its column.
  EXPECT_NEAR(analyze(lin).standard_deviations[1], 1e-3, 1e-15);
}

// Deviations of a kept parameter are those of the whole problem: the inverse of the full normal matrix.
TEST(Identifiability, ProjectsNuisanceParametersOut) {
  const Linearization lin{
      .rows = 3, .columns = 2, .jacobian = {1, 1, 1, 2, 1, 4}, .residuals = {}, .names = {"slope", "offset"}};
  // (J^T J)^-1 of {{3, 7}, {7, 21}} is {{21, -7}, {-7, 3}} / 14.
  EXPECT_NEAR(analyze(lin, 1).standard_deviations[0], std::sqrt(21.0 / 14.0), 1e-12);
  EXPECT_NEAR(analyze(lin).standard_deviations[0], std::sqrt(21.0 / 14.0), 1e-12);
}

// Printed quantiles of chi-square: 18.307 at 5 % for 10 degrees, 124.34 at 5 % for 100.
TEST(ChiSquare, TailAgreesWithPrintedQuantiles) {
  EXPECT_NEAR(chi_square_tail(18.307, 10), 0.05, 5e-4);
  EXPECT_NEAR(chi_square_tail(124.342, 100), 0.05, 2e-4);
  EXPECT_NEAR(chi_square_tail(99.334, 100), 0.5, 2e-3);
}

}  // namespace
}  // namespace palpate::test
