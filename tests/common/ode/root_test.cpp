#include "common/ode/root.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palpate {
namespace {

template <class Function>
double solve(const Function& f, double low, double high, double tolerance, int* evaluations = nullptr) {
  int count = 0;
  const auto counted = [&](double x) {
    ++count;
    return f(x);
  };
  const double root = bracketed_root(counted, low, high, f(low), f(high), tolerance);
  if (evaluations != nullptr) *evaluations = count;
  return root;
}

TEST(BracketedRoot, FindsSimpleRootsInFewEvaluations) {
  int evaluations = 0;
  EXPECT_NEAR(solve([](double x) { return std::cos(x) - x; }, 0.0, 1.0, 1e-14, &evaluations),
              0.7390851332151607, 1e-13);
  EXPECT_LT(evaluations, 15);
}

TEST(BracketedRoot, EndsOnFlatSteepAndBrokenFunctionsToo) {
  int evaluations = 0;
  EXPECT_NEAR(solve([](double x) { return std::pow(x - 0.3, 9); }, 0.0, 1.0, 1e-12, &evaluations), 0.3, 1e-2);
  EXPECT_LE(evaluations, 200);
  EXPECT_NEAR(solve([](double x) { return std::atan(1e9 * (x - 0.7)); }, 0.0, 1.0, 1e-13, &evaluations), 0.7,
              1e-12);
  EXPECT_LE(evaluations, 200);
  EXPECT_NEAR(solve([](double x) { return x < 0.123 ? -1.0 : 1.0; }, 0.0, 1.0, 1e-12, &evaluations), 0.123,
              1e-11);
  EXPECT_LE(evaluations, 200);
}

TEST(BracketedRoot, ReportsTheSideWhereTheEventHasHappened) {
  for (const double target : {0.1, 0.5, 0.9}) {
    const auto f = [&](double x) { return x * x - target * target; };
    EXPECT_GE(f(solve(f, 0.0, 1.0, 1e-9)), 0.0);
  }
}

}  // namespace
}  // namespace palpate
