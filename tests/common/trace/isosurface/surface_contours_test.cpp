// Lines of equal value on surfaces of triangles.

#include "common/trace/isosurface/surface_contours.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "common/field/analytic/volume_examples.h"
#include "tests/common/trace/sampled_scalars.h"

namespace palpate {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A plane of n x n squares of side 1 / n, each of two triangles.
IsosurfaceMesh plane(int n) {
  IsosurfaceMesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      mesh.points.emplace_back(static_cast<double>(i) / n, static_cast<double>(j) / n, 0.0);
  const auto at = [n](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

template <typename F>
std::vector<double> values(const IsosurfaceMesh& mesh, const F& f) {
  std::vector<double> out;
  for (const Vec3& x : mesh.points) out.push_back(f(x));
  return out;
}

double length_of(const SurfaceContour& line) {
  double sum = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) sum += glm::distance(line[i - 1].position, line[i].position);
  return sum;
}

TEST(SurfaceContours, AreExactForLinearValuesAndRunFromBorderToBorder) {
  const IsosurfaceMesh mesh = plane(16);
  const auto lines =
      surface_contours(mesh, values(mesh, [](const Vec3& x) { return x.x + 0.25 * x.y - 0.51; }), kInfinity);
  ASSERT_EQ(lines.size(), 1U);
  for (const EdgePoint& at : lines[0]) EXPECT_NEAR(at.position.x + 0.25 * at.position.y, 0.51, 1e-15);
  EXPECT_NEAR(length_of(lines[0]), std::hypot(1.0, 0.25), 1e-12);
  EXPECT_NEAR(std::abs(lines[0].front().position.y - lines[0].back().position.y), 1.0, 1e-15);
}

TEST(SurfaceContours, CloseOnThemselvesAndConvergeAtSecondOrder) {
  double before = 0.0;
  for (const int n : {16, 32, 64}) {
    const IsosurfaceMesh mesh = plane(n);
    const auto circle = values(mesh, [](const Vec3& x) {
      return glm::distance(x, Vec3{0.5, 0.5, 0.0}) - 0.31;
    });
    const auto lines = surface_contours(mesh, circle, kInfinity);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_EQ(lines[0].front().position, lines[0].back().position);
    const double off = std::abs(length_of(lines[0]) - 2.0 * std::numbers::pi * 0.31);
    if (before > 0.0) {
      EXPECT_NEAR(std::log2(before / off), 2.0, 0.35);
    }
    before = off;
  }
}

TEST(SurfaceContours, DoNotBranchAtCornersWithTheValue) {
  const IsosurfaceMesh mesh = plane(8);
  const auto lines = surface_contours(mesh, values(mesh, [](const Vec3& x) { return x.x - 0.5; }), kInfinity);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NEAR(length_of(lines[0]), 1.0, 1e-12);
}

TEST(SurfaceContours, LeaveOutWhatIsNotKnownAndWhereAnAngleGoesRound) {
  const IsosurfaceMesh mesh = plane(16);
  auto holed = values(mesh, [](const Vec3& x) { return x.x - 0.51; });
  for (std::size_t p = 0; p < mesh.points.size(); ++p)
    if (std::abs(mesh.points[p].y - 0.5) < 0.1) holed[p] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(surface_contours(mesh, holed, kInfinity).size(), 2U) << "parted by the hole";
  // A direction without sign that turns by 200 degrees: it is at 45 degrees twice, and jumps once.
  const auto angle = values(mesh, [](const Vec3& x) { return std::remainder(200.0 * x.x - 45.0, 180.0); });
  EXPECT_EQ(surface_contours(mesh, angle, 90.0).size(), 1U);
  const auto twice = values(mesh, [](const Vec3& x) { return std::remainder(200.0 * x.x - 10.0, 180.0); });
  EXPECT_EQ(surface_contours(mesh, twice, 90.0).size(), 2U);
}

TEST(SurfaceContours, LieOnTheEdgesOfALayer) {
  const auto field = test::on_tets(sphere_scalar(), Index3{17});
  const IsosurfaceMesh mesh = make_isosurface_mesh(*field, 1.0, 100'000);
  const auto lines = surface_contours(mesh, values(mesh, [](const Vec3& x) { return x.z - 0.1; }), kInfinity);
  ASSERT_EQ(lines.size(), 1U) << "a circle of latitude";
  for (const EdgePoint& at : lines[0]) {
    EXPECT_NEAR(at.position.z, 0.1, 1e-14);
    EXPECT_LT(glm::distance(at.position, glm::mix(mesh.points[at.below], mesh.points[at.above], at.part)),
              1e-15);
  }
}

}  // namespace
}  // namespace palpate
