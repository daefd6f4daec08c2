// A haptic grid with nodes each 50 mm: an axis leads until another pulls it over at a node.

#include "common/haptics/constraint/grid_axis.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

class GridAxisTest : public ::testing::Test {
 protected:
  void use(double threshold, double teeth) {
    ChainSettings settings;
    settings.grid_axis = {.threshold = threshold, .teeth = teeth};
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

TEST_F(GridAxisTest, HasTeethOnItsNodes) {
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

}  // namespace
}  // namespace palpate
