// Every stepper on the Kepler problem, whose solution is known: nonlinear, coupled, far from symmetric at
// eccentricity 0.4. A linear or constant field would hide wrong coefficients.

#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include <gtest/gtest.h>

#include "common/math/vec.h"
#include "common/ode/explicit_step.h"
#include "common/ode/rosenbrock.h"
#include "common/ode/step_control.h"
#include "common/ode/tableau.h"

namespace palpate {
namespace {

constexpr double kEccentricity = 0.4;

Vec4 kepler(const Vec4& y) {
  const double r = std::hypot(y.x, y.y);
  return {y.z, y.w, -y.x / (r * r * r), -y.y / (r * r * r)};
}

/// Position and velocity at time `t` after the nearest point, semi-axis 1 (Kepler's equation by Newton).
Vec4 kepler_at(double t) {
  double e = t;
  for (int i = 0; i < 50; ++i)
    e -= (e - kEccentricity * std::sin(e) - t) / (1.0 - kEccentricity * std::cos(e));
  const double b = std::sqrt(1.0 - kEccentricity * kEccentricity);
  const double rate = 1.0 / (1.0 - kEccentricity * std::cos(e));
  return {std::cos(e) - kEccentricity, b * std::sin(e), -std::sin(e) * rate, b * std::cos(e) * rate};
}

template <class Tableau>
struct ExplicitKepler {
  static constexpr int kOrder = Tableau::kOrder, kEmbedded = Tableau::kEmbeddedOrder,
                       kDense = Tableau::kDenseOrder;
  ExplicitStep<Tableau, Vec4> step;
  void run(const Vec4& y, double h) {
    step.run([](double, const Vec4& x) { return kepler(x); }, 0.0, y, h);
  }
  Vec4 end() const { return step.end; }
  Vec4 error() const { return step.error(); }
  Vec4 dense(double theta) const { return dense_value(step.start, step.dense(), theta); }
};

struct RodasKepler {
  using Step = RodasStep<4>;
  static constexpr int kOrder = Step::kOrder, kEmbedded = Step::kEmbeddedOrder, kDense = Step::kDenseOrder;
  Step step;
  static Step::Vector array(const Vec4& y) { return {y.x, y.y, y.z, y.w}; }
  static Vec4 vec(const Step::Vector& y) { return {y[0], y[1], y[2], y[3]}; }
  void run(const Vec4& y, double h) {
    const double r = std::hypot(y.x, y.y), r3 = r * r * r, r5 = r3 * r * r;
    Step::Matrix j{};
    j[0][2] = j[1][3] = 1.0;
    j[2][0] = -1.0 / r3 + 3.0 * y.x * y.x / r5;
    j[2][1] = j[3][0] = 3.0 * y.x * y.y / r5;
    j[3][1] = -1.0 / r3 + 3.0 * y.y * y.y / r5;
    ASSERT_TRUE(step.run([](const Step::Vector& x) { return array(kepler(vec(x))); }, j, array(y), h));
  }
  Vec4 end() const { return vec(step.end); }
  Vec4 error() const { return vec(step.error); }
  Vec4 dense(double theta) const {
    const auto q = step.dense();
    return vec(step.start) + theta * (vec(q[0]) + theta * (vec(q[1]) + theta * vec(q[2])));
  }
};

template <class Stepper>
class Steppers : public testing::Test {};
using AllSteppers = testing::Types<ExplicitKepler<Euler>, ExplicitKepler<Rk4>, ExplicitKepler<Bs32>,
                                   ExplicitKepler<Rk34>, ExplicitKepler<Dp54>, RodasKepler>;
TYPED_TEST_SUITE(Steppers, AllSteppers);

/// Slope of log(error) over log(h) for halvings of the step.
double observed_order(const std::vector<double>& error) {
  return std::log2(error[error.size() - 2] / error[error.size() - 1]);
}

TYPED_TEST(Steppers, ConvergeWithTheirOrderOnTheKeplerProblem) {
  std::vector<double> error;
  const int first = TypeParam::kOrder >= 4 ? 128 : 1024;
  for (int n = first; n <= 4 * first; n *= 2) {
    TypeParam stepper;
    Vec4 y = kepler_at(0.0);
    const double h = 3.0 / n;
    for (int i = 0; i < n; ++i) {
      stepper.run(y, h);
      y = stepper.end();
    }
    error.push_back(glm::length(y - kepler_at(3.0)));
  }
  EXPECT_NEAR(observed_order(error), TypeParam::kOrder, 0.2);
}

TYPED_TEST(Steppers, ErrorEstimateFallsWithTheEmbeddedOrder) {
  if (TypeParam::kEmbedded == 0) return;  // nothing embedded to look at
  std::vector<double> estimate;
  for (double h = 0.08; h > 0.015; h *= 0.5) {
    TypeParam stepper;
    stepper.run(kepler_at(0.7), h);
    estimate.push_back(glm::length(stepper.error()));
  }
  const int local = std::min(TypeParam::kOrder, TypeParam::kEmbedded) + 1;
  EXPECT_NEAR(observed_order(estimate), local, 0.3);
}

TYPED_TEST(Steppers, DenseOutputHasItsLocalOrderAndMeetsTheEnds) {
  std::vector<double> error;
  for (double h = 0.16; h > 0.03; h *= 0.5) {
    TypeParam stepper;
    stepper.run(kepler_at(0.7), h);
    double worst = 0.0;
    for (const double theta : {0.2, 0.4, 0.6, 0.8}) {
      worst = std::max(worst, glm::length(stepper.dense(theta) - kepler_at(0.7 + theta * h)));
    }
    error.push_back(worst);
    EXPECT_LT(glm::length(stepper.dense(1.0) - stepper.end()), 1e-14);
    EXPECT_LT(glm::length(stepper.dense(0.0) - kepler_at(0.7)), 1e-15);
  }
  EXPECT_NEAR(observed_order(error), TypeParam::kDense + 1, 0.35);
}

// Stability function of RODAS from its own steps: x' = lambda x as a real 2 x 2 system.
std::complex<double> rodas_growth(std::complex<double> z) {
  RodasStep<2> step;
  const RodasStep<2>::Matrix j{{{z.real(), -z.imag()}, {z.imag(), z.real()}}};
  const auto f = [&](const std::array<double, 2>& x) {
    return std::array<double, 2>{z.real() * x[0] - z.imag() * x[1], z.imag() * x[0] + z.real() * x[1]};
  };
  EXPECT_TRUE(step.run(f, j, {1.0, 0.0}, 1.0));
  return {step.end[0], step.end[1]};
}

TEST(Rodas, IsAStableOnTheImaginaryAxisAndLeftOfIt) {
  for (const double real : {0.0, -0.1, -1.0, -10.0, -1e3}) {
    for (double imaginary = 1e-2; imaginary < 1e6; imaginary *= 1.3) {
      EXPECT_LE(std::abs(rodas_growth({real, imaginary})), 1.0 + 1e-12) << real << " " << imaginary;
    }
  }
}

TEST(Rodas, DampsInfinitelyStiffModes) {
  EXPECT_LT(std::abs(rodas_growth({-1e6, 0.0})), 1e-5);
  EXPECT_LT(std::abs(rodas_growth({-1e12, 0.0})), 1e-10);
  EXPECT_NEAR(rodas_growth({-0.1, 0.3}).real(), std::exp(-0.1) * std::cos(0.3), 1e-5);
}

// Prothero and Robinson 1974: x' = lambda (x - cos t) - sin t has the solution cos t whatever lambda is.
TEST(Rodas, FollowsASmoothSolutionThroughAnyStiffness) {
  for (const double lambda : {-1e2, -1e5, -1e8, -1e11}) {
    const auto f = [&](const std::array<double, 2>& y) {
      return std::array<double, 2>{lambda * (y[0] - std::cos(y[1])) - std::sin(y[1]), 1.0};
    };
    std::array<double, 2> y{1.0, 0.0};
    RodasStep<2> step;
    constexpr int kSteps = 40;
    for (int i = 0; i < kSteps; ++i) {
      const RodasStep<2>::Matrix j{{{lambda, lambda * std::sin(y[1]) - std::cos(y[1])}, {0.0, 0.0}}};
      ASSERT_TRUE(step.run(f, j, y, 2.0 / kSteps));
      y = step.end;
    }
    EXPECT_NEAR(y[0], std::cos(2.0), 2e-5) << lambda;
  }
}

TEST(Rodas, RefusesASingularSystemAndValuesThatAreNotFinite) {
  RodasStep<1> step;
  const auto grow = [](const std::array<double, 1>& x) { return std::array<double, 1>{4.0 * x[0]}; };
  EXPECT_FALSE(step.run(grow, {{{4.0}}}, {1.0}, 1.0));  // 1 / (gamma h) = 4
  const auto bad = [](const std::array<double, 1>&) { return std::array<double, 1>{NAN}; };
  EXPECT_FALSE(step.run(bad, {{{0.0}}}, {1.0}, 1.0));
}

/// Integrates one turn of the Kepler problem under control of the error per unit step.
template <class Stepper>
std::pair<double, int> controlled_turn(double tolerance) {
  StepControl control(std::min(Stepper::kOrder, Stepper::kEmbedded));
  Stepper stepper;
  Vec4 y = kepler_at(0.0);
  double t = 0.0, h = 0.1;
  int steps = 0, tries = 0;
  while (t < 6.0 && ++tries < 100000) {
    h = std::min(h, 6.0 - t);
    stepper.run(y, h);
    const auto verdict = control.judge(glm::length(stepper.error()) / (tolerance * h));
    if (verdict.accepted) {
      t += h;
      y = stepper.end();
      ++steps;
    }
    h *= verdict.factor;
  }
  return {glm::length(y - kepler_at(6.0)), steps};
}

TEST(StepControl, ErrorFollowsTheTolerance) {
  for (const double tolerance : {1e-5, 1e-7, 1e-9}) {
    // The problem itself amplifies errors by some 50 over the turn.
    EXPECT_LT(controlled_turn<ExplicitKepler<Dp54>>(tolerance).first, 100.0 * tolerance);
    EXPECT_LT(controlled_turn<RodasKepler>(tolerance).first, 100.0 * tolerance);
    EXPECT_LT(controlled_turn<ExplicitKepler<Rk34>>(tolerance).first, 100.0 * tolerance);
  }
  EXPECT_GT(controlled_turn<ExplicitKepler<Dp54>>(1e-5).first, 1e-9) << "steps are far too small";
}

TEST(StepControl, StepsGrowInNumberWithTheRootOfTheTolerance) {
  const double ratio = static_cast<double>(controlled_turn<ExplicitKepler<Dp54>>(1e-9).second) /
                       controlled_turn<ExplicitKepler<Dp54>>(1e-5).second;
  EXPECT_NEAR(ratio, 10.0, 3.0);  // 1e4 to the power 1/4
}

// Its own logarithm and power of two are rough, over every octave of the ratio.
TEST(StepControl, FactorIsThatOfTheFormulaToAThousandth) {
  constexpr double kPower = 4.0;
  double previous = 1.0;
  StepControl control(kPower);
  for (double ratio = 1.0; ratio > 1.1e-4; ratio *= 0.93) {
    const double exact = 0.9 * std::pow(ratio, -0.7 / kPower) * std::pow(previous, 0.4 / kPower);
    EXPECT_NEAR(control.judge(ratio).factor, exact, 1e-3 * exact) << ratio;
    previous = ratio;
  }
}

TEST(StepControl, RejectsWhatIsNotANumberAndDoesNotGrowRightAfter) {
  StepControl control(4.0);
  EXPECT_FALSE(control.judge(NAN).accepted);
  EXPECT_FALSE(control.judge(HUGE_VAL).accepted);
  const auto rejected = control.judge(16.0);
  EXPECT_FALSE(rejected.accepted);
  EXPECT_NEAR(rejected.factor, 0.45, 1e-12);  // 0.9 / 16^(1/4)
  const auto after = control.judge(1e-3);
  EXPECT_TRUE(after.accepted);
  EXPECT_LE(after.factor, 1.0);
  EXPECT_GT(control.judge(1e-3).factor, 1.0);
}

}  // namespace
}  // namespace palpate
