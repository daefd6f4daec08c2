// The linear flow against exponentials in closed form.

#include "common/ode/linear_step.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(LinearStep, GrowsDecaysAndTurnsAsTheExponential) {
  const Mat3 j{{-2.0, 0, 0}, {0, 0.5, 0}, {0, 0, -30.0}};
  const Mat3 g = linear_growth(j, 1.0);
  // Rates of at most half a step's limit: the rule is good to a few per cent.
  EXPECT_NEAR(g[0][0], std::exp(-2.0), 0.01 * std::exp(-2.0));
  EXPECT_NEAR(g[1][1], std::exp(0.5), 0.01);
  EXPECT_LE(std::abs(g[2][2]), 1e-12);
  const Mat3 turn = linear_growth(Mat3{{0, 5.0, 0}, {-5.0, 0, 0}, {0, 0, 0}}, 1.0);
  EXPECT_NEAR(std::hypot(turn[0][0], turn[0][1]), 1.0, 1e-12);
  EXPECT_EQ(turn[2][2], 1.0);
}

// Rates 1 and 1e6 side by side: the slow one is kept, the fast one is gone, and with its sign turned beyond all
// bounds.
TEST(LinearStep, KeepsTheSlowRateBesideAFastOne) {
  const Mat3 g = linear_growth(Mat3{{-1e6, 0, 0}, {1e6, -1.0, 0}, {0, 0, 0}}, 1.0);
  EXPECT_NEAR(g[1][1], std::exp(-1.0), 1e-6);
  EXPECT_LE(std::abs(g[0][0]), 1e-300);
  EXPECT_FALSE(linear_growth(Mat3{{1e6, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 1.0)[0][0] < 1e300);
}

TEST(LinearStep, ReachesTheFixedPoint) {
  const Mat3 j{{-1.0, 6.0, 0.0}, {-6.0, -1.0, 0.0}, {0.5, 0.0, -1e4}};
  const Vec3 rest{0.1, -0.2, 0.3};
  LinearStep flow(j, 1.0 / LinearStep::row_sum(j));
  for (int i = 0; i < 22; ++i) flow.repeat();
  EXPECT_LE(glm::distance(flow.reach * (j * -rest), rest), 1e-10);
}

}  // namespace
}  // namespace palpate
