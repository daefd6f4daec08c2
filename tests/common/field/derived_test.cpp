#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/field/analytic/examples.h"
#include "common/field/vorticity_field.h"
#include "tests/support/sampled.h"

namespace palpate {
namespace {

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }

/// Pure shear v = (y, 0, 0).
Mat3 shear() {
  Mat3 m{0.0};
  m[1][0] = 1.0;
  return m;
}

/// Rigid rotation about z at unit rate.
Mat3 rotation() {
  Mat3 m{0.0};
  m[0][1] = 1.0;
  m[1][0] = -1.0;
  return m;
}

TEST(Derived, RigidRotationIsAllVortex) {
  EXPECT_EQ(divergence(rotation()), 0.0);
  EXPECT_EQ(vorticity(rotation()), Vec3(0.0, 0.0, 2.0));
  EXPECT_DOUBLE_EQ(q_criterion(rotation()), 1.0);  // |W|^2 = 2, S = 0
  EXPECT_DOUBLE_EQ(lambda2(rotation()), -1.0);     // W^2 = diag(-1, -1, 0)
}

TEST(Derived, ShearIsNoVortex) {
  EXPECT_EQ(vorticity(shear()), Vec3(0.0, 0.0, -1.0));
  EXPECT_DOUBLE_EQ(q_criterion(shear()), 0.0);
  EXPECT_DOUBLE_EQ(lambda2(shear()), 0.0);
}

TEST(Derived, StrainHasNegativeQAndPositiveLambda2) {
  const Mat3 m{Vec3{1, 0, 0}, Vec3{0, 2, 0}, Vec3{0, 0, -3}};
  EXPECT_DOUBLE_EQ(divergence(m), 0.0);
  EXPECT_DOUBLE_EQ(q_criterion(m), -7.0);
  EXPECT_DOUBLE_EQ(lambda2(m), 4.0);  // squares 1, 4, 9
}

TEST(Derived, QIsMinusHalfTheTraceAndTheDefinitionsHold) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 200; ++i) {
    Mat3 m{0.0};
    for (int c = 0; c < 3; ++c) m[c] = 2.0 * Vec3{unit(random), unit(random), unit(random)} - 1.0;
    const Mat3 s = 0.5 * (m + glm::transpose(m));
    const Mat3 w = 0.5 * (m - glm::transpose(m));
    double norms = 0.0;
    for (int c = 0; c < 3; ++c) norms += glm::dot(w[c], w[c]) - glm::dot(s[c], s[c]);
    EXPECT_NEAR(q_criterion(m), 0.5 * norms, 1e-14);
    // det (S^2 + W^2 - lambda_2) = 0 and the middle one of three.
    const Mat3 a = s * s + w * w;
    const double l2 = lambda2(m);
    EXPECT_NEAR(glm::determinant(a - Mat3{l2}), 0.0, 1e-13);
  }
}

TEST(Derived, MeasuresOfSampledFieldsTendToTheFormulas) {
  const auto formula = example("abc");
  const VectorChoice choice{VectorChoice::Kind::kArray, Association::kPoint, {"velocity"}, "velocity"};
  const auto exact = make_vector_field(formula);
  for (const Measure measure : {Measure::kSpeed, Measure::kDivergence, Measure::kVorticityMagnitude,
                                Measure::kQ, Measure::kLambda2}) {
    std::array<double, 2> error{};
    for (std::size_t level = 0; level < 2; ++level) {
      const int n = level == 0 ? 17 : 33;
      const auto field = make_vector_field({test::sample_uniform(*formula, {n, n, n})}, choice, "test");
      std::mt19937_64 random(6);
      CellHint hint;
      for (int i = 0; i < 1000; ++i) {
        const Vec3 x = formula->bounds().size() * Vec3{unit(random), unit(random), unit(random)};
        const ScalarSample a = sample_measure(*field, measure, x, hint);
        const ScalarSample b = sample_measure(*exact, measure, x, hint);
        ASSERT_EQ(a.status, SampleStatus::kOk);
        ASSERT_EQ(b.status, SampleStatus::kOk);
        error[level] += std::abs(a.value - b.value) / 1000.0;
      }
    }
    const double order = measure == Measure::kSpeed ? 2.0 : 1.0;
    if (error[0] > 1e-6) {
      EXPECT_NEAR(std::log2(error[0] / error[1]), order, 0.25) << static_cast<int>(measure);
    }
  }
}

TEST(Derived, OutsideThereIsNoMeasure) {
  const auto field = make_vector_field(example("abc"));
  CellHint hint;
  for (const Measure measure : {Measure::kSpeed, Measure::kQ}) {
    const ScalarSample sample = sample_measure(*field, measure, Vec3{99.0}, hint);
    EXPECT_EQ(sample.status, SampleStatus::kOutside);
    EXPECT_EQ(sample.value, 0.0);
  }
}

}  // namespace
}  // namespace palpate
