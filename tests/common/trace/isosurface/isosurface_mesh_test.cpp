// Isosurfaces as triangles: closed, on the surface that is felt, of second order, and defined for any data.

#include "common/trace/isosurface/isosurface_mesh.h"

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/analytic/volume_examples.h"
#include "tests/common/trace/sampled_scalars.h"
#include "tests/support/torus_scalar.h"

namespace palpate {
namespace {

using test::on_lattice;
using test::on_rectilinear;
using test::on_tets;
using test::on_uniform;

constexpr std::size_t kPlenty = 1'000'000;

/// How often each directed edge occurs.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed_edges(const IsosurfaceMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
  }
  return edges;
}

/// Every edge once in each direction: closed, orientable, no edge shared by more than two.
void expect_closed(const IsosurfaceMesh& mesh) {
  ASSERT_FALSE(mesh.triangles.empty());
  const auto edges = directed_edges(mesh);
  std::size_t open = 0, crowded = 0;
  for (const auto& [edge, count] : edges) {
    if (count != 1) ++crowded;
    if (!edges.contains({edge.second, edge.first})) ++open;
  }
  EXPECT_EQ(open, 0U);
  EXPECT_EQ(crowded, 0U);
}

/// V - E + F: 2 of a sphere, 0 of a torus.
int euler_characteristic(const IsosurfaceMesh& mesh) {
  return static_cast<int>(mesh.points.size()) - static_cast<int>(directed_edges(mesh).size() / 2) +
         static_cast<int>(mesh.triangles.size());
}

/// Enclosed by a mesh that is counter-clockwise from outside.
double volume_of(const IsosurfaceMesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles) {
    sum += glm::dot(mesh.points[t[0]], glm::cross(mesh.points[t[1]], mesh.points[t[2]]));
  }
  return sum / 6.0;
}

double area_of(const IsosurfaceMesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.points[t[0]];
    sum += 0.5 * glm::length(glm::cross(mesh.points[t[1]] - a, mesh.points[t[2]] - a));
  }
  return sum;
}

void expect_on_surface(const IsosurfaceMesh& mesh, const ScalarField& field) {
  const double range = field.highest() - field.lowest();
  double worst = 0.0;
  std::size_t unlit = 0;
  CellHint hint;
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const ScalarSample sample = field.sample(mesh.points[i], hint);
    ASSERT_EQ(sample.status, SampleStatus::kOk);
    worst = std::fmax(worst, std::abs(sample.value - mesh.level));
    const double length = glm::length(Vec3(mesh.normals[i]));
    if (!(std::abs(length - 1.0) < 1e-5)) ++unlit;
  }
  EXPECT_LE(worst, 1e-13 * range);
  EXPECT_EQ(unlit, 0U);
}

TEST(IsosurfaceMesh, IsClosedOnEveryKindOfGrid) {
  constexpr double kLevel = 1.0;
  for (const auto& field :
       {on_uniform(sphere_scalar(), {20, 23, 26}), on_rectilinear(sphere_scalar(), {22, 20, 24}),
        on_lattice(sphere_scalar(), {38, 38, 32}, test::sheared_steps(0.1)),
        on_lattice(sphere_scalar(), {22, 22, 22}, Mat3{-0.12}), on_tets(sphere_scalar(), {14, 15, 16}),
        make_scalar_field(sphere_scalar())}) {
    const IsosurfaceMesh mesh = make_isosurface_mesh(*field, kLevel, kPlenty);
    expect_closed(mesh);
    expect_on_surface(mesh, *field);
    EXPECT_EQ(euler_characteristic(mesh), 2);
    EXPECT_GT(volume_of(mesh), 0.0) << "values rise outwards: counter-clockwise from there";
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      EXPECT_GT(glm::dot(Vec3(mesh.normals[i]), mesh.points[i]), 0.9) << "normals are the radii, nearly";
    }
  }
}

TEST(IsosurfaceMesh, OfATorusHasItsHole) {
  const auto field = on_uniform(test::torus_scalar(), {41, 41, 21});
  const IsosurfaceMesh mesh = make_isosurface_mesh(*field, 0.16, kPlenty);
  expect_closed(mesh);
  EXPECT_EQ(euler_characteristic(mesh), 0);
}

TEST(IsosurfaceMesh, AreaAndVolumeOfASphereConvergeAtOrderTwo) {
  const double radius = 1.1, area = 4.0 * std::numbers::pi * radius * radius, volume = area * radius / 3.0;
  for (const bool sheared : {false, true}) {
    double area_before = 0.0, volume_before = 0.0;
    for (const int n : {11, 21, 41}) {
      const auto field =
          sheared ? on_lattice(sphere_scalar(), {2 * n, 2 * n, 2 * n}, test::sheared_steps(2.5 / (n - 1)))
                  : on_uniform(sphere_scalar(), Index3{n});
      const IsosurfaceMesh mesh = make_isosurface_mesh(*field, radius * radius, kPlenty);
      const double area_error = std::abs(area_of(mesh) - area),
                   volume_error = std::abs(volume_of(mesh) - volume);
      if (n > 11) {
        // Halving the spacing: four times less, but for lower orders.
        EXPECT_NEAR(area_before / area_error, 4.0, 0.6);
        EXPECT_NEAR(volume_before / volume_error, 4.0, 0.6);
      }
      area_before = area_error;
      volume_before = volume_error;
    }
    EXPECT_LT(area_before / area, 0.003);
  }
}

TEST(IsosurfaceMesh, CoarserMeshesStillLieOnTheSurface) {
  const auto field = on_uniform(sphere_scalar(), Index3{41});
  const IsosurfaceMesh whole = make_isosurface_mesh(*field, 1.0, kPlenty);
  EXPECT_EQ(whole.stride, 1);
  const IsosurfaceMesh coarse = make_isosurface_mesh(*field, 1.0, whole.triangles.size() / 3);
  EXPECT_EQ(coarse.stride, 2);
  EXPECT_LE(coarse.triangles.size(), whole.triangles.size() / 3);
  expect_closed(coarse);
  expect_on_surface(coarse, *field);
  const auto sheared = on_lattice(sphere_scalar(), {38, 38, 32}, test::sheared_steps(0.1));
  const IsosurfaceMesh thinned =
      make_isosurface_mesh(*sheared, 1.0, make_isosurface_mesh(*sheared, 1.0, kPlenty).triangles.size() / 3);
  EXPECT_EQ(thinned.stride, 2);
  expect_closed(thinned);
  expect_on_surface(thinned, *sheared);
  for (std::size_t i = 0; i < thinned.points.size(); ++i)
    EXPECT_GT(glm::dot(Vec3(thinned.normals[i]), thinned.points[i]), 0.9);
  EXPECT_TRUE(make_isosurface_mesh(*field, 1.0, 1).triangles.empty()) << "one triangle is no surface";
  const auto tets = on_tets(sphere_scalar(), {14, 15, 16});
  EXPECT_THROW((void)make_isosurface_mesh(*tets, 1.0, 100), Error);
}

TEST(IsosurfaceMesh, HasABorderOnlyWhereTheDataEnds) {
  const auto field = on_uniform(sphere_scalar(), Index3{21});  // the sphere of radius 2 leaves the box
  const IsosurfaceMesh mesh = make_isosurface_mesh(*field, 4.0, kPlenty);
  const auto edges = directed_edges(mesh);
  std::size_t border = 0;
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    if (edges.contains({edge.second, edge.first})) continue;
    ++border;
    for (const std::uint32_t v : {edge.first, edge.second}) {
      const Vec3 x = glm::abs(mesh.points[v]);
      EXPECT_NEAR(std::max({x.x, x.y, x.z}), 1.5, 1e-12);
    }
  }
  EXPECT_GT(border, 100U);
}

/// x + |y| is the very level at whole grid points, along a crease; values are whole numbers.
class Steps final : public AnalyticScalar {
 public:
  explicit Steps(double hole) : hole_(hole) {}
  [[nodiscard]] double value(const Vec3& x) const noexcept override {
    if (glm::length(x) < hole_) return std::numeric_limits<double>::quiet_NaN();
    return std::floor(std::abs(x.x)) + std::floor(std::abs(x.y)) + std::floor(std::abs(x.z));
  }
  [[nodiscard]] Jet3 jet(const Vec3& x) const noexcept override {
    Jet3 jet;
    jet.value = value(x);
    return jet;
  }
  [[nodiscard]] Box bounds() const noexcept override { return {Vec3{-4.0}, Vec3{4.0}}; }
  [[nodiscard]] std::string name() const override { return "steps"; }
  [[nodiscard]] std::string description() const override { return "whole numbers"; }

 private:
  double hole_;
};

TEST(IsosurfaceMesh, PlateausAtTheVeryLevelHaveAClosedBorder) {
  const auto field = on_uniform(std::make_shared<Steps>(0.0), Index3{9});
  const IsosurfaceMesh mesh = make_isosurface_mesh(*field, 2.0, kPlenty);
  for (const Vec3& x : mesh.points) EXPECT_TRUE(is_finite(x));
  for (const Vec3f& n : mesh.normals) EXPECT_TRUE(is_finite(Vec3(n)));
  const auto edges = directed_edges(mesh);
  for (const auto& [edge, count] : edges) {
    const Vec3 a = glm::abs(mesh.points[edge.first]);
    const bool inside = std::max({a.x, a.y, a.z}) < 4.0;
    EXPECT_TRUE(!inside || edges.contains({edge.second, edge.first}));
  }
}

TEST(IsosurfaceMesh, IsDefinedForHolesFlatFieldsAndLevelsOutOfReach) {
  const auto holes = on_uniform(std::make_shared<Steps>(2.5), Index3{9});
  const IsosurfaceMesh around = make_isosurface_mesh(*holes, 4.5, kPlenty);
  EXPECT_FALSE(around.triangles.empty());
  for (const Vec3& x : around.points) EXPECT_TRUE(is_finite(x));
  const auto empty = on_uniform(std::make_shared<Steps>(100.0), Index3{5});  // nothing is finite
  EXPECT_TRUE(make_isosurface_mesh(*empty, 0.0, kPlenty).triangles.empty());
  const auto field = on_uniform(sphere_scalar(), Index3{9});
  for (const double level : {-1.0, 100.0, 1e308, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_TRUE(make_isosurface_mesh(*field, level, kPlenty).triangles.empty()) << level;
  }
  // The lowest value is above itself: the level of a minimum shows nothing, or that point.
  for (const Vec3& x : make_isosurface_mesh(*field, 0.0, kPlenty).points) EXPECT_TRUE(is_finite(x));
}

TEST(IsosurfaceMesh, CanBeCancelled) {
  const auto field = on_uniform(sphere_scalar(), Index3{9});
  Progress progress;
  progress.cancel();
  EXPECT_THROW((void)make_isosurface_mesh(*field, 1.0, kPlenty, &progress), Cancelled);
}

}  // namespace
}  // namespace palpate
