// Surfaces of triangles: what is mended when they are made, and where a walk over them ends.

#include "common/geometry/surface_mesh.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/round_surfaces.h"

namespace palpate {
namespace {

using test::Triangles;

SurfaceMesh mesh_of(const Triangles& made) { return SurfaceMesh(made.points, made.triangles); }

/// The distance to the nearest triangle, each asked in turn.
double nearest_of_all(const SurfaceMesh& mesh, const Vec3& x) {
  double least = HUGE_VAL;
  for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t)
    least = std::min(least, glm::distance(x, mesh.nearest_on(t, x).point));
  return least;
}

TEST(SurfaceMesh, OfATorusIsClosedAndNeedsNoCare) {
  const SurfaceMesh mesh = mesh_of(test::torus_triangles(0.08, 0.03, 48, 24));
  EXPECT_TRUE(mesh.care().sentences().empty());
  EXPECT_EQ(mesh.care().pieces, 1U);
  EXPECT_EQ(mesh.points().size(), 48U * 24U);
}

TEST(SurfaceMesh, TurnsTrianglesThatAreWoundAgainstTheirNeighbours) {
  Triangles made = test::ball_triangles(0.1, 4);
  std::mt19937_64 random(3);
  std::size_t wrong = 0;
  for (Triangle& t : made.triangles) {
    if (random() % 5 != 0) continue;
    std::swap(t[0], t[1]);
    ++wrong;
  }
  const SurfaceMesh mesh = mesh_of(made);
  EXPECT_EQ(mesh.care().turned, wrong);
  for (std::size_t p = 0; p < mesh.points().size(); ++p)
    ASSERT_GT(glm::dot(mesh.normals()[p], mesh.points()[p]), 0.0) << "all outwards again";
  ASSERT_EQ(mesh.care().sentences().size(), 1U);
  EXPECT_NE(mesh.care().sentences()[0].find("turned around"), std::string::npos);
}

TEST(SurfaceMesh, SaysWhatIsOpenFlatSharedAndTwisted) {
  const Triangles plate = test::plate_triangles(1.0, 0.0);
  EXPECT_EQ(mesh_of(plate).care().open, 4U);
  Triangles flat = plate;
  flat.points.push_back({2.0, 1.0, 0.0});
  flat.points.push_back({NAN, 0.0, 0.0});
  flat.triangles.push_back({1, 1, 2});
  flat.triangles.push_back({2, 3, 4});  // along a line
  flat.triangles.push_back({2, 3, 5});
  EXPECT_EQ(mesh_of(flat).care().empty, 3U);
  EXPECT_EQ(mesh_of(flat).triangles().size(), 2U);
  Triangles fin = plate;
  fin.points.push_back({0.0, 0.0, 1.0});
  fin.triangles.push_back({0, 2, 4});
  EXPECT_EQ(mesh_of(fin).care().several, 1U);
  // A band of Moebius.
  Triangles band;
  constexpr std::uint32_t kParts = 12;
  for (std::uint32_t i = 0; i < kParts; ++i) {
    const double a = 2.0 * std::numbers::pi * i / kParts;
    const Vec3 out{std::cos(a), std::sin(a), 0.0}, up{0.0, 0.0, 1.0};
    const Vec3 across = 0.2 * (std::cos(0.5 * a) * out + std::sin(0.5 * a) * up);
    band.points.push_back(out - across);
    band.points.push_back(out + across);
    const bool last = i + 1 == kParts;
    const std::uint32_t p = 2 * i, q = last ? 1 : p + 2, r = last ? 0 : p + 3;
    band.triangles.push_back({p, q, p + 1});
    band.triangles.push_back({p + 1, q, r});
  }
  EXPECT_GT(mesh_of(band).care().twisted, 0U);
  EXPECT_EQ(mesh_of(test::torus_triangles(1.0, 0.2, 20, 12)).care().twisted, 0U);
}

TEST(SurfaceMesh, WalksToTheNearestPlaceThatThereIs) {
  const double wide = 0.08, thin = 0.03;
  const SurfaceMesh torus = mesh_of(test::torus_triangles(wide, thin, 64, 32));
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> turn(-std::numbers::pi, std::numbers::pi), depth(0.0, 0.8 * thin);
  SurfacePlace place;
  Vec3 x{wide + thin, 0.0, 0.0};
  double a = 0.0, b = 0.0;
  for (int n = 0; n < 3000; ++n) {
    // Steps short enough to stay over the same side of the tube.
    a += 0.02 * turn(random);
    b += 0.02 * turn(random);
    const double within = thin - depth(random);
    const double out = wide + within * std::cos(b);
    x = {out * std::cos(a), out * std::sin(a), within * std::sin(b)};
    int looked = 0;
    if (n == 0) place.triangle = torus.nearest(x, 1.0, 1 << 20).thing;
    ASSERT_TRUE(torus.walk(x, place, 1 << 20, looked));
    // A face keeps the place until its edge is reached, where the next one is nearer by d (1 - cos 0.2).
    ASSERT_LE(glm::distance(x, place.point), nearest_of_all(torus, x) + 5e-4) << "step " << n;
  }
}

TEST(SurfaceMesh, WalksOverSliversAndFans) {
  // A fan of a thousand triangles about one corner, a thousand times as long as wide.
  Triangles fan;
  fan.points.push_back(Vec3{0.0});
  constexpr std::uint32_t kParts = 1000;
  for (std::uint32_t i = 0; i < kParts; ++i) {
    const double a = 2.0 * std::numbers::pi * i / kParts;
    fan.points.push_back({std::cos(a), std::sin(a), 0.3});
    fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % kParts});
  }
  const SurfaceMesh mesh = mesh_of(fan);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-0.6, 0.6);
  for (int n = 0; n < 300; ++n) {
    const Vec3 x{unit(random), unit(random), 0.2 + 0.2 * unit(random)};
    SurfacePlace place;
    int looked = 0;
    ASSERT_TRUE(mesh.walk(x, place, 1 << 20, looked));
    // The cone is convex from below and a valley from above: one nearest place but on its axis.
    ASSERT_NEAR(glm::distance(x, place.point), nearest_of_all(mesh, x), 1e-6);
  }
}

TEST(SurfaceMesh, IsMetWithoutCracks) {
  const SurfaceMesh ball = mesh_of(test::ball_triangles(0.1, 3));
  // Straight through edges and corners, too.
  for (const Vec3& p : ball.points()) {
    const BoxTree::Found found = ball.first_met(2.0 * p, Vec3{0.0}, 1 << 20);
    ASSERT_NE(found.thing, BoxTree::kNone);
    ASSERT_NEAR(found.value, 0.5, 1e-9);
  }
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 20'000; ++n) {
    const Vec3 d = glm::normalize(Vec3{normal(random), normal(random), normal(random)});
    ASSERT_NE(ball.first_met(0.2 * d, Vec3{0.0}, 1 << 20).thing, BoxTree::kNone) << n;
    ASSERT_EQ(ball.first_met(0.2 * d, 0.11 * d, 1 << 20).thing, BoxTree::kNone) << n;
  }
}

TEST(SurfaceMesh, TellsOneFromAnother) {
  Triangles made = test::ball_triangles(0.1, 2);
  const std::uint64_t before = mesh_of(made).fingerprint();
  EXPECT_EQ(mesh_of(made).fingerprint(), before);
  made.points[7].x += 1e-12;
  EXPECT_NE(mesh_of(made).fingerprint(), before);
}

}  // namespace
}  // namespace palpate
