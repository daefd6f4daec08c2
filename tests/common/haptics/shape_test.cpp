// Shapes of widgets: when they hold, and what is left of it at their middle, ends and bends.

#include "common/haptics/constraint/shape.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace palpate {
namespace {

/// @param reach release distance; the probe is caught within half of it.
LinkUpdate at(Constraint& shape, const Vec3& probe, double reach, const UpdateBudget& budget = {}) {
  ChainSettings settings;
  settings.shape = {.snap_distance = 0.5 * reach, .release_distance = reach};
  shape.apply(settings);
  LinkUpdate link;
  shape.update(probe, budget, link);
  return link;
}

TEST(Shape, CatchesNearAndLetsGoFar) {
  SphereConstraint sphere(Vec3{0.0}, 0.1);
  constexpr double kReach = 0.02;
  LinkUpdate link = at(sphere, {0.115, 0.0, 0.0}, kReach);
  EXPECT_EQ(link.state, HoldState::kFree) << "within the release distance, but never caught";
  EXPECT_EQ(link.proxy, Vec3(0.115, 0.0, 0.0));
  link = at(sphere, {0.109, 0.0, 0.0}, kReach);
  EXPECT_EQ(link.state, HoldState::kHeld);
  EXPECT_TRUE(link.jumped) << "the force begins anew";
  EXPECT_LE(glm::distance(link.proxy, Vec3(0.1, 0.0, 0.0)), 1e-16);
  link = at(sphere, {0.0, 0.119, 0.0}, kReach);
  EXPECT_EQ(link.state, HoldState::kHeld);
  EXPECT_FALSE(link.jumped);
  link = at(sphere, {0.0, 0.121, 0.0}, kReach);
  EXPECT_EQ(link.state, HoldState::kReleased);
  EXPECT_TRUE(link.jumped);
  EXPECT_EQ(link.proxy, Vec3(0.0, 0.121, 0.0));
  EXPECT_EQ(at(sphere, {0.0, 0.119, 0.0}, kReach).state, HoldState::kFree) << "no flicker at the edge";
}

TEST(Sphere, FadesAtItsCentreAndKeepsItsDirection) {
  SphereConstraint sphere({1.0, 2.0, 3.0}, 0.1);
  EXPECT_EQ(at(sphere, {1.05, 2.0, 3.0}, 1.0).kappa, Vec3{1.0});
  const LinkUpdate half = at(sphere, {1.0125, 2.0, 3.0}, 1.0);
  EXPECT_NEAR(half.kappa.x, 0.5, 1e-12) << "half of the inner quarter";
  const LinkUpdate centre = at(sphere, {1.0, 2.0, 3.0}, 1.0);
  EXPECT_EQ(centre.kappa, Vec3{0.0});
  EXPECT_LE(glm::distance(centre.proxy, Vec3(1.1, 2.0, 3.0)), 1e-15);
}

TEST(Circle, HoldsAcrossItsPlaneOnItsAxisToo) {
  CircleConstraint circle(Vec3{0.0}, {0.0, 0.0, 3.0}, 0.1);
  const LinkUpdate link = at(circle, {0.03, 0.04, 0.02}, 1.0);
  EXPECT_LE(glm::distance(link.proxy, Vec3(0.06, 0.08, 0.0)), 1e-15);
  const LinkUpdate axis = at(circle, {0.0, 0.0, 0.02}, 1.0);
  const Vec3 pull = axis.frame * (axis.kappa * ((axis.proxy - Vec3{0.0, 0.0, 0.02}) * axis.frame));
  EXPECT_LE(glm::distance(pull, Vec3(0.0, 0.0, -0.02)), 1e-15) << "no direction in the plane, and none felt";
}

TEST(Polyline, StopsAtItsEndsAndGoesRoundItsBends) {
  PolylineConstraint line({{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}});
  EXPECT_EQ(at(line, {-0.5, 0.0, 0.0}, 9.0).proxy, Vec3(0.0, 0.0, 0.0));
  EXPECT_EQ(at(line, {0.75, 0.2, 0.0}, 9.0).proxy, Vec3(0.75, 0.0, 0.0));
  EXPECT_EQ(at(line, {0.75, 0.3, 0.0}, 9.0).proxy, Vec3(1.0, 0.3, 0.0)) << "nearer to the next";
  EXPECT_EQ(at(line, {1.2, -0.2, 0.0}, 9.0).proxy, Vec3(1.0, 0.0, 0.0)) << "round the corner";
  EXPECT_EQ(at(line, {1.2, 1.7, 0.0}, 9.0).proxy, Vec3(1.0, 1.0, 0.0));
  EXPECT_EQ(at(line, {1.2, 1.7, 0.0}, 9.0).jacobian, Mat3{0.0}) << "it stays at the end";
}

// A hairpin whose sides are 0.1 apart: from the one the nearest point of all would leap to the other halfway.
TEST(Polyline, StaysOnItsOwnSide) {
  PolylineConstraint line({{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 0.1, 0.0}, {0.0, 0.1, 0.0}});
  EXPECT_EQ(at(line, {0.5, 0.0, 0.0}, 1.0).proxy, Vec3(0.5, 0.0, 0.0));
  EXPECT_EQ(at(line, {0.5, 0.09, 0.0}, 1.0).proxy, Vec3(0.5, 0.0, 0.0));
  PolylineConstraint fresh({{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 0.1, 0.0}, {0.0, 0.1, 0.0}});
  EXPECT_EQ(at(fresh, {0.5, 0.09, 0.0}, 1.0).proxy, Vec3(0.5, 0.1, 0.0)) << "a free one takes the nearest";
}

TEST(Polyline, SearchesOverSeveralUpdatesWhereTheBudgetIsSmall) {
  std::vector<Vec3> vertices;
  for (int i = 0; i <= 10; ++i) vertices.emplace_back(i, 0.0, 0.0);
  PolylineConstraint line(vertices);
  const UpdateBudget four{.iterations = 4};
  const Vec3 probe{8.5, 0.25, 0.0};
  EXPECT_EQ(at(line, probe, 1.0, four).state, HoldState::kFree);
  EXPECT_EQ(at(line, probe, 1.0, four).state, HoldState::kFree);
  const LinkUpdate link = at(line, probe, 1.0, four);
  EXPECT_EQ(link.state, HoldState::kHeld) << "ten segments in the third";
  EXPECT_EQ(link.proxy, Vec3(8.5, 0.0, 0.0));
  const LinkUpdate behind = at(line, {1.5, 0.25, 0.0}, 9.0, four);
  EXPECT_EQ(behind.state, HoldState::kFellBack);
  EXPECT_LE(behind.iterations, 4);
  EXPECT_EQ(behind.proxy.y, 0.0) << "on the line all the same";
}

}  // namespace
}  // namespace palpate
