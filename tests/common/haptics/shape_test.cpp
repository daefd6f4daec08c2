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

TEST(Polyline, StaysWithinItsBudget) {
  std::vector<Vec3> vertices;
  for (int i = 0; i <= 10; ++i) vertices.emplace_back(i, 0.0, 0.0);
  PolylineConstraint line(vertices);
  const UpdateBudget four{.iterations = 4};
  const LinkUpdate link = at(line, {8.5, 0.25, 0.0}, 1.0, four);
  EXPECT_EQ(link.state, HoldState::kHeld) << "a tree finds it among ten";
  EXPECT_EQ(link.proxy, Vec3(8.5, 0.0, 0.0));
  EXPECT_LE(link.iterations, 4);
  const LinkUpdate behind = at(line, {1.5, 0.25, 0.0}, 9.0, four);
  EXPECT_EQ(behind.state, HoldState::kFellBack);
  EXPECT_LE(behind.iterations, 4);
  EXPECT_EQ(behind.proxy.y, 0.0) << "on the line all the same";
}

TEST(Polyline, OfManyCatchesTheNearestAndKeepsToIt) {
  std::vector<std::vector<Vec3>> lines;
  for (int i = 0; i < 400; ++i) {
    auto& line = lines.emplace_back();
    for (int k = 0; k <= 100; ++k) line.emplace_back(0.01 * k, 0.01 * i, 0.002 * std::sin(0.1 * k));
  }
  PolylineConstraint all(lines, PolylineConstraint::Ends::kStop);
  EXPECT_EQ(at(all, {0.5, 1.234, 0.5}, 0.02).state, HoldState::kFree) << "none is near";
  LinkUpdate link = at(all, {0.5, 1.2321, 0.0}, 0.02);
  EXPECT_EQ(link.state, HoldState::kHeld);
  EXPECT_NEAR(link.proxy.y, 1.23, 1e-12);
  EXPECT_LE(link.iterations, UpdateBudget{}.iterations);
  link = at(all, {0.5, 1.238, 0.0}, 0.02);
  EXPECT_NEAR(link.proxy.y, 1.23, 1e-12) << "the next one is nearer now";
}

TEST(Polyline, JoinedGoesOnWhereItsEndsMeet) {
  const std::vector<std::vector<Vec3>> square{
      {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 0.0}}};
  PolylineConstraint joined(square, PolylineConstraint::Ends::kJoined);
  (void)at(joined, {0.0, 0.2, 0.0}, 1.0);
  EXPECT_EQ(at(joined, {0.2, 0.0, 0.0}, 1.0).proxy, Vec3(0.2, 0.0, 0.0));
  EXPECT_FALSE(at(joined, {0.0, 0.0, 0.0}, 1.0).at_end);
  PolylineConstraint open(square, PolylineConstraint::Ends::kStop);
  (void)at(open, {0.0, 0.2, 0.0}, 1.0);
  const LinkUpdate stopped = at(open, {0.2, -0.01, 0.0}, 1.0);
  EXPECT_EQ(stopped.proxy, Vec3(0.0, 0.0, 0.0));
  EXPECT_TRUE(stopped.at_end);
}

TEST(Plane, HoldsFromBothSidesAndPopsOff) {
  PlaneConstraint plane({0.0, 0.0, 0.3}, {0.0, 0.0, 2.0});
  EXPECT_EQ(at(plane, {1.0, 2.0, 0.5}, 0.2).state, HoldState::kFree);
  EXPECT_EQ(at(plane, {1.0, 2.0, 0.35}, 0.2).proxy, Vec3(1.0, 2.0, 0.3));
  EXPECT_EQ(at(plane, {1.0, 3.0, 0.15}, 0.2).proxy, Vec3(1.0, 3.0, 0.3));
  EXPECT_EQ(at(plane, {1.0, 3.0, 0.05}, 0.2).state, HoldState::kReleased);
}

/// Settings by which a hand is carried at 50 mm/s with 0.8 N at most, by springs of 200 N/m.
ChainSettings carrying() {
  ChainSettings settings{.stiffness = 200.0};
  settings.shape = {.snap_distance = 0.01, .release_distance = 0.02};
  settings.carry = {.speed = 0.05, .force = 0.8};
  return settings;
}

LinkUpdate after(Constraint& shape, const Vec3& probe, double seconds) {
  shape.advance(seconds);
  LinkUpdate link;
  shape.update(probe, {}, link);
  return link;
}

TEST(Carry, TakesAHandThatGoesAlongAtItsSpeed) {
  PolylineConstraint line({{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.1, 0.2, 0.0}});
  line.apply(carrying());
  Vec3 hand{0.01, 0.0, 0.0};
  (void)after(line, hand, 0.0);
  constexpr double kStep = 1e-3;
  for (int n = 1; n <= 3000; ++n) {
    const LinkUpdate link = after(line, hand, kStep);
    const double arc = 0.01 + 0.05 * kStep * n;
    const Vec3 expected = arc < 0.1 ? Vec3{arc, 0.0, 0.0} : Vec3{0.1, arc - 0.1, 0.0};
    ASSERT_LE(glm::distance(link.proxy, expected), 1e-12) << n;
    hand = link.proxy;  // it gives way at once
  }
}

TEST(Carry, WaitsForAHandThatHoldsBackAndPushesNoHarder) {
  PolylineConstraint line(Vec3{0.0}, Vec3{0.3, 0.0, 0.0});
  line.apply(carrying());
  const Vec3 hand{0.1, 0.001, 0.0};
  LinkUpdate link = after(line, hand, 0.0);
  for (int n = 1; n <= 1000; ++n) {
    link = after(line, hand, 1e-3);
    ASSERT_LE(glm::length(link.extra_force), 0.8 + 1e-12);
    ASSERT_NEAR(link.extra_force.x, std::min(0.8, 200.0 * 0.05 * 1e-3 * n), 1e-9) << n;
    ASSERT_EQ(link.kappa, Vec3(0.0, 1.0, 1.0)) << "along it that force is all";
  }
  EXPECT_NEAR(link.proxy.x, 0.1 + 0.8 / 200.0, 1e-12) << "it waits there";
  link = after(line, {0.2, 0.0, 0.0}, 1e-3);
  EXPECT_NEAR(link.proxy.x, 0.2 - 0.8 / 200.0, 1e-12) << "and is pushed on by one that runs ahead";
  EXPECT_NEAR(link.extra_force.x, -0.8, 1e-9);
}

TEST(Carry, StopsAtAnEndAndGoesRoundACircle) {
  PolylineConstraint line(Vec3{0.0}, Vec3{0.02, 0.0, 0.0});
  line.apply(carrying());
  LinkUpdate link = after(line, {0.019, 0.0, 0.0}, 0.0);
  for (int n = 0; n < 100; ++n) link = after(line, {0.0199, 0.0, 0.0}, 1e-3);
  EXPECT_EQ(link.proxy, Vec3(0.02, 0.0, 0.0));
  EXPECT_TRUE(link.at_end);

  CircleConstraint circle(Vec3{0.0}, {0.0, 0.0, 1.0}, 0.03);
  circle.apply(carrying());
  Vec3 hand{0.03, 0.0, 0.0};
  (void)after(circle, hand, 0.0);
  constexpr int kSteps = 10'000;
  for (int n = 1; n <= kSteps; ++n) {
    const double angle = 0.05 * 1e-3 * n / 0.03;
    link = after(circle, hand, 1e-3);
    ASSERT_LE(glm::distance(link.proxy, 0.03 * Vec3{std::cos(angle), std::sin(angle), 0.0}), 1e-11) << n;
    hand = link.proxy;
  }
}

TEST(Carry, LeavesAHandAloneWhereItsSpeedIsZero) {
  ChainSettings still = carrying();
  still.carry.speed = 0.0;
  PolylineConstraint line(Vec3{0.0}, Vec3{0.3, 0.0, 0.0});
  line.apply(still);
  (void)after(line, {0.1, 0.001, 0.0}, 0.0);
  const LinkUpdate link = after(line, {0.1, 0.001, 0.0}, 1.0);
  EXPECT_LE(glm::distance(link.proxy, Vec3(0.1, 0.0, 0.0)), 1e-15);
  EXPECT_EQ(link.extra_force, Vec3{0.0});
}

}  // namespace
}  // namespace palpate
