// A haptic grid with nodes each 50 mm: an axis leads until another pulls it over at a node.

#include "common/haptics/constraint/grid_axis.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace palpate {
namespace {

class GridAxisTest : public ::testing::Test {
 protected:
  void use(double threshold, double detents) {
    ChainSettings settings;
    settings.grid_axis = {.threshold = threshold, .detents = detents};
    grid_.apply(settings);
  }
  /// Millimetres in and out.
  LinkUpdate at(const Vec3& probe) {
    LinkUpdate link;
    grid_.update(1e-3 * probe, UpdateBudget{}, link);
    link.proxy = glm::round(1e9 * link.proxy) * 1e-6;
    return link;
  }

  GridAxis grid_{Vec3{0.0}, Mat3{1.0}, Vec3{0.050}};
};

TEST_F(GridAxisTest, LeadsAlongOneAxisUntilAnotherPullsItOver) {
  use(0.010, 0.0);
  EXPECT_EQ(at({12.0, 3.0, -4.0}).proxy, Vec3(12.0, 0.0, 0.0)) << "the nearest line";
  EXPECT_EQ(at({52.0, 9.0, 0.0}).proxy, Vec3(52.0, 0.0, 0.0));
  const LinkUpdate over = at({52.0, 10.5, 0.0});
  EXPECT_EQ(over.proxy, Vec3(50.0, 10.5, 0.0)) << "at the node";
  EXPECT_TRUE(over.jumped);
  EXPECT_EQ(grid_.leading(), 1);
  EXPECT_EQ(at({53.0, 30.0, 1.0}).proxy, Vec3(50.0, 30.0, 0.0));
  EXPECT_EQ(at({53.0, 98.0, -11.0}).proxy, Vec3(50.0, 100.0, -11.0));
  EXPECT_EQ(grid_.leading(), 2);
}

TEST_F(GridAxisTest, KeepsItsAxisBetweenNodes) {
  use(0.010, 0.0);
  (void)at({12.0, 0.0, 0.0});
  EXPECT_EQ(at({25.0, 40.0, 0.0}).proxy, Vec3(25.0, 0.0, 0.0)) << "no node within the threshold";
  EXPECT_EQ(at({41.0, 40.0, 0.0}).proxy, Vec3(50.0, 40.0, 0.0));
}

TEST_F(GridAxisTest, HasDetentsOnItsNodes) {
  use(0.010, 0.25);
  LinkUpdate link = at({12.0, 0.0, 0.0});
  EXPECT_EQ(link.proxy, Vec3(0.0, 0.0, 0.0));
  EXPECT_EQ(link.kappa, Vec3(0.25, 1.0, 1.0));
  EXPECT_EQ(at({49.0, 0.0, 0.0}).proxy, Vec3(0.0, 0.0, 0.0));
  EXPECT_EQ(at({51.0, 0.0, 0.0}).proxy, Vec3(50.0, 0.0, 0.0));
  EXPECT_EQ(at({1.0, 0.0, 0.0}).proxy, Vec3(50.0, 0.0, 0.0)) << "hysteresis of one tooth";
  link = at({50.0, -12.0, 0.0});
  EXPECT_EQ(link.kappa, Vec3(1.0, 0.25, 1.0));
  EXPECT_EQ(link.proxy, Vec3(50.0, 0.0, 0.0));
}

/// The potential of a notch, (2): its pull is zero at both ends and nowhere leaps.
TEST(GridAxisLandmarks, CatchAndLetGoWithoutALeap) {
  constexpr double kMark = 0.0213, kReach = 0.004, kStep = 1e-6;
  const GridAxis::Landmark mark{{1.0, 0.0, 0.0}, kMark};
  GridAxis grid(Vec3{0.0}, Mat3{1.0}, Vec3{0.050}, {&mark, 1});
  ChainSettings settings;
  settings.grid_axis.notch = kReach;
  grid.apply(settings);
  double before = 0.0, work = 0.0, most = 0.0;
  bool exact = false;
  for (double x = 0.010; x < 0.032; x += kStep) {
    LinkUpdate link;
    grid.update({x, 0.0, 0.0}, UpdateBudget{}, link);
    const double pull = link.kappa.x * (link.proxy.x - x);
    EXPECT_LE(std::abs(pull - before), 1.1 * kStep) << "slope of the potential's force, at most 1, at " << x;
    exact = exact || link.proxy.x == kMark;
    most = std::max(most, std::abs(pull));
    work += pull * kStep;
    before = pull;
  }
  EXPECT_TRUE(exact) << "the very place of the landmark";
  // The largest of d (1 - (d/w)^2)^2 is at d = w / sqrt 5.
  EXPECT_NEAR(most, 16.0 / 25.0 / std::sqrt(5.0) * kReach, 1e-8);
  EXPECT_NEAR(work, 0.0, 1e-10) << "in and out again costs nothing";
}

TEST(GridAxisLandmarks, AreWhereAnotherAxisTakesOver) {
  // An oblique plane x + y = 40 mm: crossed at x = 40 mm on the line y = 0.
  const GridAxis::Landmark mark{glm::normalize(Vec3{1.0, 1.0, 0.0}), 0.040 / std::sqrt(2.0)};
  GridAxis grid(Vec3{0.0}, Mat3{1.0}, Vec3{0.100}, {&mark, 1});
  ChainSettings settings;
  settings.grid_axis.switch_at = GridSwitch::kMarks;
  grid.apply(settings);
  LinkUpdate link;
  grid.update({0.010, 0.0, 0.0}, UpdateBudget{}, link);
  grid.update({0.020, 0.020, 0.0}, UpdateBudget{}, link);
  EXPECT_EQ(grid.leading(), 0) << "no landmark here";
  grid.update({0.0995, 0.020, 0.0}, UpdateBudget{}, link);
  EXPECT_EQ(grid.leading(), 0) << "a node is none";
  grid.update({0.041, 0.020, 0.0}, UpdateBudget{}, link);
  EXPECT_EQ(grid.leading(), 1);
  EXPECT_NEAR(grid.position().x, 0.040, 1e-15);
}

/// Along axes that do not lead, the coordinates in the grid keep their bits, whatever the hand does and
/// however the grid is turned.
TEST(GridAxisProperty, LocksTheOtherAxesBitForBit) {
  std::mt19937 random{11};
  std::uniform_real_distribution<double> jitter{-0.004, 0.004}, angle{-3.0, 3.0};
  for (int run = 0; run < 20; ++run) {
    const Vec3 first = glm::normalize(Vec3{angle(random), angle(random), angle(random)});
    const Vec3 third = glm::normalize(glm::cross(first, Vec3{angle(random), 1.0, angle(random)}));
    const Mat3 axes{first, glm::cross(third, first), third};
    GridAxis grid({0.1, -0.2, 0.3}, axes, Vec3{0.00137, 0.0021, 0.0017});
    grid.apply({});
    Vec3 hand{0.11, -0.21, 0.32};
    LinkUpdate link;
    grid.update(hand, UpdateBudget{}, link);
    for (int n = 0; n < 2000; ++n) {
      const Vec3 before = grid.position();
      const int led = grid.leading();
      hand += Vec3{jitter(random), jitter(random), jitter(random)};
      LinkUpdate next;
      grid.update(hand, UpdateBudget{}, next);
      if (grid.leading() != led) continue;
      for (int a = 0; a < 3; ++a) {
        if (a == led) continue;
        ASSERT_EQ(before[a], grid.position()[a]);
      }
    }
  }
}

}  // namespace
}  // namespace palpate
