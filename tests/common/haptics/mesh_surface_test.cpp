// Surfaces of triangles under a hand: the proxy against closed forms, thin sheets, edges, rims, corners, cracks.

#include "common/haptics/constraint/mesh_surface.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/allocation_guard.h"
#include "tests/support/round_surfaces.h"

namespace palpate {
namespace {

using test::Triangles;

Workspace metres() { return {1.0, LocalFrame{}}; }

std::shared_ptr<const SurfaceMesh> mesh_of(const Triangles& made) {
  return std::make_shared<const SurfaceMesh>(made.points, made.triangles);
}

void append(Triangles& all, const Triangles& more) {
  const auto first = static_cast<std::uint32_t>(all.points.size());
  all.points.insert(all.points.end(), more.points.begin(), more.points.end());
  for (const Triangle& t : more.triangles)
    all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

LinkUpdate at(MeshConstraint& surface, const Vec3& probe, const UpdateBudget& budget = {}) {
  LinkUpdate link;
  surface.update(probe, budget, link);
  return link;
}

/// Goes straight there in `steps` steps.
LinkUpdate lead(MeshConstraint& surface, const Vec3& from, const Vec3& to, int steps = 50) {
  LinkUpdate link;
  for (int n = 1; n <= steps; ++n) link = at(surface, glm::mix(from, to, 1.0 * n / steps));
  return link;
}

TEST(MeshSurface, OfAPlateIsAWallFromBothSides) {
  MeshConstraint plate(mesh_of(test::plate_triangles(0.1, 0.02)), metres());
  EXPECT_EQ(at(plate, {0.01, 0.02, 0.03}).state, HoldState::kFree);
  LinkUpdate link = at(plate, {0.03, -0.02, 0.005});
  EXPECT_EQ(link.state, HoldState::kHeld);
  EXPECT_TRUE(link.crossed);
  EXPECT_LE(glm::distance(link.proxy, Vec3(0.03, -0.02, 0.02)), 1e-15);
  EXPECT_NEAR(plate.contact().depth, 0.015, 1e-15);
  link = at(plate, {0.031, -0.02, 0.0201});
  EXPECT_EQ(link.state, HoldState::kFree);
  EXPECT_TRUE(link.crossed);
  EXPECT_FALSE(link.jumped) << "it lets go without a pull";
  MeshConstraint below(mesh_of(test::plate_triangles(0.1, 0.02)), metres());
  (void)at(below, {0.0, 0.0, 0.0});
  EXPECT_LE(glm::distance(at(below, {0.01, 0.01, 0.04}).proxy, Vec3(0.01, 0.01, 0.02)), 1e-15);
}

TEST(MeshSurface, HoldsAtTheSurfaceOnWhicheverWayItIsComeFrom) {
  for (const double height : {1e-3, 1e-8, 1e-12, 0.0}) {
    MeshConstraint plate(mesh_of(test::plate_triangles(0.1, 0.0)), metres());
    (void)at(plate, {0.0, 0.01, 0.01});
    // Onto the surface to rounding, along it, and then through.
    for (int n = 0; n < 20; ++n) (void)at(plate, {0.001 * n, 0.01, n % 2 == 0 ? height : 0.0});
    const LinkUpdate link = at(plate, {0.02, 0.01, -0.004});
    ASSERT_EQ(link.state, HoldState::kHeld) << height;
    ASSERT_NEAR(link.proxy.z, 0.0, 1e-15);
  }
}

// Boxes of slanted slivers lie about the way, and cost an update its visits: what is behind them waits for the next
// update, and is not passed.
TEST(MeshSurface, IsNotPassedWhereOneUpdateCannotLookAtTheWholeWay) {
  constexpr int kSlivers = 4000;
  constexpr double kApart = 1e-5, kWall = kSlivers * kApart;
  Triangles all = test::plate_triangles(0.1, 0.0);
  for (Vec3& point : all.points) point = {kWall, point.x, point.y};
  Triangles slivers;
  for (int n = 0; n < kSlivers; ++n) {
    const double x = kApart * n;
    slivers.points.insert(slivers.points.end(),
                          {{x, 0.01, -0.005}, {x, -0.005, 0.01}, {x + 5e-6, 0.01, -0.005}});
    const auto first = static_cast<std::uint32_t>(3 * n);
    slivers.triangles.push_back({first, first + 1, first + 2});
  }
  append(all, slivers);
  MeshConstraint surface(mesh_of(all), metres());
  (void)at(surface, {-0.001, 0.0, 0.0});
  LinkUpdate link = at(surface, {kWall + 0.002, 0.0, 0.0});
  EXPECT_EQ(link.state, HoldState::kFellBack);
  int updates = 1;
  for (; link.state != HoldState::kHeld && updates < 100; ++updates)
    link = at(surface, {kWall + 0.002, 0.0, 0.0});
  EXPECT_LT(updates, 100);
  EXPECT_NEAR(link.proxy.x, kWall, 1e-12);
}

// The proxy is never farther from the hand than the surface by formula is, and what chords take off it.
TEST(MeshSurface, OfAMillionTrianglesFollowsABallByFormula) {
  constexpr double kRadius = 0.1;
  const auto mesh = mesh_of(test::ball_triangles(kRadius, 8));  // 524 288
  ASSERT_GT(mesh->triangles().size(), 500'000U);
  MeshConstraint ball(mesh, metres());
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> pressed(0.0, 0.03);
  constexpr double kSag = 2e-6;  // [m] of an edge of 0.6 mm
  Vec3 d{1.0, 0.0, 0.0};
  (void)at(ball, 1.01 * kRadius * d);
  int fell_back = 0;
  double worst = 0.0;
  for (int n = 0; n < 50'000; ++n) {
    // Up to 4 m/s, trembling, and now and then away and back.
    d = glm::normalize(d + 0.012 * Vec3{normal(random), normal(random), normal(random)});
    const double depth = pressed(random);
    const LinkUpdate link = at(ball, (kRadius - depth) * d);
    fell_back += link.state == HoldState::kFellBack ? 1 : 0;
    if (link.state != HoldState::kHeld) continue;
    worst = std::max(worst, glm::distance(link.proxy, (kRadius - depth) * d) - depth);
    ASSERT_LE(glm::distance(link.proxy, kRadius * d), 3e-4) << "step " << n;
  }
  EXPECT_LE(worst, kSag);
  EXPECT_EQ(fell_back, 0);
}

TEST(MeshSurface, FollowsATorusThroughItsHole) {
  constexpr double kWide = 0.08, kThin = 0.03;
  const auto mesh = mesh_of(test::torus_triangles(kWide, kThin, 720, 360));
  MeshConstraint torus(mesh, metres());
  const auto place = [](double a, double b, double within) {
    const double out = kWide + within * std::cos(b);
    return Vec3{out * std::cos(a), out * std::sin(a), within * std::sin(b)};
  };
  (void)at(torus, place(0.0, 0.0, 1.1 * kThin));
  double worst = 0.0;
  for (int n = 0; n < 40'000; ++n) {
    const double a = 0.002 * n, b = 0.0071 * n, within = kThin - 0.012 * (1.0 - std::cos(0.01 * n)) * 0.5;
    const LinkUpdate link = at(torus, place(a, b, within));
    if (link.state != HoldState::kHeld) continue;
    ASSERT_LE(glm::distance(link.proxy, place(a, b, kThin)), 4e-4) << "step " << n;
    worst = std::max(worst, glm::distance(link.proxy, place(a, b, within)) - (kThin - within));
  }
  EXPECT_LE(worst, 4e-6);
}

TEST(MeshSurface, KeepsToItsSheetOfAThinPlate) {
  Triangles thin = test::plate_triangles(0.1, 0.0);
  append(thin, test::plate_triangles(0.1, -1e-4));
  MeshConstraint plate(mesh_of(thin), metres());
  (void)at(plate, {0.0, 0.0, 0.01});
  const LinkUpdate link = lead(plate, {0.0, 0.0, 0.01}, {0.05, 0.02, -0.03});
  EXPECT_EQ(link.state, HoldState::kHeld);
  EXPECT_LE(glm::distance(link.proxy, Vec3(0.05, 0.02, 0.0)), 1e-12) << "the other sheet is nearer";
  MeshConstraint leapt(mesh_of(thin), metres());
  (void)at(leapt, {0.0, 0.0, 1.0});
  EXPECT_NEAR(at(leapt, {0.01, 0.0, -2.0}).proxy.z, 0.0, 1e-12) << "a leap is a way, too";
}

TEST(MeshSurface, SlipsAroundARimAndIsFreeBelow) {
  MeshConstraint plate(mesh_of(test::plate_triangles(0.1, 0.0)), metres());
  (void)at(plate, {0.09, 0.0, 0.01});
  (void)lead(plate, {0.09, 0.0, 0.01}, {0.09, 0.0, -0.01});
  const LinkUpdate link = lead(plate, {0.09, 0.0, -0.01}, {0.12, 0.0, -0.01});
  EXPECT_EQ(link.proxy, Vec3(0.12, 0.0, -0.01));
  EXPECT_EQ(link.state, HoldState::kFree);
  EXPECT_EQ(at(plate, {0.05, 0.0, -0.01}).state, HoldState::kFree) << "back below it";
  EXPECT_NEAR(at(plate, {0.05, 0.0, 0.01}).proxy.z, 0.0, 1e-12) << "it is a wall from there";
}

/// A box from -0.05 to 0.05 in each direction.
Triangles box_triangles() {
  Triangles box;
  for (int i = 0; i < 8; ++i)
    box.points.push_back(0.05 * Vec3{(i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1});
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return box;
}

TEST(MeshSurface, GoesOverSharpEdgesAndIntoCorners) {
  MeshConstraint outside(mesh_of(box_triangles()), metres());
  (void)at(outside, {0.0, 0.0, 0.06});
  (void)lead(outside, {0.0, 0.0, 0.06}, {0.03, 0.0, 0.045});
  LinkUpdate link = lead(outside, {0.03, 0.0, 0.045}, {0.055, 0.0, 0.045});
  EXPECT_EQ(link.state, HoldState::kFree) << "around the edge";
  link = lead(outside, {0.055, 0.0, 0.045}, {0.045, 0.0, 0.03});
  EXPECT_LE(glm::distance(link.proxy, Vec3(0.05, 0.0, 0.03)), 1e-12) << "held by the side";

  MeshConstraint inside(mesh_of(box_triangles()), metres());
  (void)at(inside, Vec3{0.0});
  link = lead(inside, Vec3{0.0}, {0.08, 0.02, 0.01});
  EXPECT_LE(glm::distance(link.proxy, Vec3(0.05, 0.02, 0.01)), 1e-12);
  link = lead(inside, {0.08, 0.02, 0.01}, {0.08, 0.07, 0.01});
  EXPECT_LE(glm::distance(link.proxy, Vec3(0.05, 0.05, 0.01)), 1e-12) << "an edge";
  EXPECT_LE(glm::distance(link.jacobian[2], Vec3(0.0, 0.0, 1.0)), 1e-12);
  link = lead(inside, {0.08, 0.07, 0.01}, {0.08, 0.07, 0.09});
  EXPECT_LE(glm::distance(link.proxy, Vec3(0.05, 0.05, 0.05)), 1e-12) << "a corner";
  EXPECT_EQ(link.jacobian, Mat3{0.0});
  link = lead(inside, {0.08, 0.07, 0.09}, {0.03, 0.07, 0.03});
  EXPECT_LE(glm::distance(link.proxy, Vec3(0.03, 0.05, 0.03)), 1e-12) << "from wall to wall";
  EXPECT_EQ(lead(inside, {0.03, 0.07, 0.03}, Vec3{0.0}).state, HoldState::kFree);
}

// Faces that meet without a common edge, as those of CAD programs do.
TEST(MeshSurface, HasNoCracksWhereEdgesDoNotAgree) {
  Triangles floor{{{-0.1, -0.1, 0.0},
                   {0.0, -0.1, 0.0},
                   {0.0, 0.1, 0.0},
                   {-0.1, 0.1, 0.0},
                   {0.0, -0.1, 0.0},
                   {0.1, -0.1, 0.0},
                   {0.1, 0.1, 0.0},
                   {0.0, 0.1, 0.0},
                   {0.0, 0.03, 0.0}},
                  {{0, 1, 2}, {0, 2, 3}, {4, 5, 8}, {5, 6, 8}, {6, 7, 8}}};
  MeshConstraint surface(mesh_of(floor), metres());
  (void)at(surface, {-0.05, 0.01, 0.01});
  (void)lead(surface, {-0.05, 0.01, 0.01}, {-0.05, 0.01, -0.01});
  for (int n = 0; n <= 400; ++n) {
    const double x = -0.05 + 0.1 * n / 400.0;
    const LinkUpdate link = at(surface, {x, 0.01, -0.01});
    ASSERT_LE(glm::distance(link.proxy, Vec3(x, 0.01, 0.0)), 1e-9) << "at " << x;
  }
}

TEST(MeshSurface, GoesOnWhereItsBudgetEnded) {
  const auto mesh = mesh_of(test::ball_triangles(0.1, 6));
  MeshConstraint ball(mesh, metres());
  (void)at(ball, {0.11, 0.0, 0.0});
  (void)at(ball, {0.09, 0.0, 0.0});
  const UpdateBudget small{.iterations = 8};
  LinkUpdate link = at(ball, {0.0, 0.095, 0.0}, small);
  EXPECT_EQ(link.state, HoldState::kFellBack);
  EXPECT_LE(link.iterations, 8);
  EXPECT_NEAR(glm::length(link.proxy), 0.1, 1e-4) << "on the surface all the same";
  for (int n = 0; n < 200; ++n) link = at(ball, {0.0, 0.095, 0.0}, small);
  EXPECT_EQ(link.state, HoldState::kHeld);
  EXPECT_LE(glm::distance(link.proxy, Vec3(0.0, 0.1, 0.0)), 3e-3);
}

TEST(MeshSurface, AllocatesNothing) {
  const auto mesh = mesh_of(test::ball_triangles(0.1, 5));
  MeshConstraint ball(mesh, metres());
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal(0.0, 0.08);
  const test::AllocationGuard allocations;
  for (int n = 0; n < 5000; ++n) (void)at(ball, {normal(random), normal(random), normal(random)});
  EXPECT_EQ(allocations.count(), 0U);
}

}  // namespace
}  // namespace palpate
