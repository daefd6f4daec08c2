// What the slopes of a step tell of a kink within it, against the error that the method makes there in closed form.

#include "common/trace/tract/face_steps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "common/ode/tableau.h"

namespace palpate {
namespace {

using Slopes = std::array<double, Dp54::kStages>;

double rest_of(const Slopes& slopes) {
  return std::sqrt(SlopeRest<Dp54>::square(slopes, [](double a, double b) { return a * b; }));
}

TEST(SlopeRest, IsNothingOfAParabola) {
  Slopes slopes{};
  for (int i = 0; i < Dp54::kStages; ++i) slopes[i] = 2.0 - 3.0 * Dp54::c[i] + 5.0 * Dp54::c[i] * Dp54::c[i];
  EXPECT_LT(rest_of(slopes), 1e-13);
}

/// x' = max(0, t - at) over [0, 1]: the solution is (1 - at)^2 / 2.
TEST(SlopeRest, BoundsTheErrorOverAKinkWhereverItLies) {
  double largest = 0.0, squares = 0.0, of_pair = 0.0;
  int places = 0;
  for (double at = 0.001; at < 0.9995; at += 0.001, ++places) {
    Slopes slopes{};
    double sum = 0.0, pair = 0.0;
    for (int i = 0; i < Dp54::kStages; ++i) {
      slopes[i] = std::max(0.0, Dp54::c[i] - at);
      sum += Dp54::b[i] * slopes[i];
      pair += Dp54::e[i] * slopes[i];
    }
    const double off = std::abs(0.5 * (1.0 - at) * (1.0 - at) - sum), rest = rest_of(slopes);
    ASSERT_GT(rest, 0.0) << at;
    largest = std::max(largest, off / rest);
    squares += off * off / (rest * rest);
    of_pair += std::abs(pair) < 0.02 * off ? 1.0 : 0.0;
  }
  EXPECT_NEAR(largest, 0.951, 0.005) << "of what is left, at most";
  EXPECT_LT(std::sqrt(squares / places), 0.45) << "in the mean";
  EXPECT_GT(of_pair, 0.1 * places) << "where the embedded pair says next to nothing";
}

}  // namespace
}  // namespace palpate
