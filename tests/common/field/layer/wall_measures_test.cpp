// Areas of the surfaces and thickness of the wall against closed forms of the analytic ventricle.
#include "common/field/layer/wall_measures.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/index.h"
#include "common/field/analytic/ventricle.h"
#include "common/field/layer/laplace.h"
#include "common/field/layer/way_lengths.h"

namespace palpate {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kParts = 400;

template <typename Function>
double integral(double from, double to, const Function& f) {
  double sum = 0.0;
  for (int i = 0; i < kParts; ++i) {
    const double a = from + (to - from) * i / kParts, b = from + (to - from) * (i + 1) / kParts;
    sum += (b - a) / 6.0 * (f(a) + 4.0 * f(0.5 * (a + b)) + f(b));
  }
  return sum;
}

/// Of the ellipsoid of constant lambda up to mu_base: 2 pi times the integral of h_mu h_theta.
double area_of_layer(const Ventricle& v, double lambda) {
  return integral(0.0, v.mu_base, [&](double mu) {
    return 2.0 * kPi * v.focus * v.focus * std::hypot(std::sinh(lambda), std::sin(mu)) * std::sinh(lambda) *
           std::sin(mu);
  });
}
/// Of the hyperboloid of constant mu between the surfaces.
double area_of_base(const Ventricle& v) {
  return integral(v.lambda_inner, v.lambda_outer, [&](double lambda) {
    return 2.0 * kPi * v.focus * v.focus * std::hypot(std::sinh(lambda), std::sin(v.mu_base)) *
           std::sinh(lambda) * std::sin(v.mu_base);
  });
}
/// Along the hyperbola of constant mu and theta.
double thickness_at(const Ventricle& v, double mu) {
  return integral(v.lambda_inner, v.lambda_outer,
                  [&](double lambda) { return v.focus * std::hypot(std::sinh(lambda), std::sin(mu)); });
}

struct Measured {
  Ventricle shape;
  std::shared_ptr<const FieldGrid> grid;
  WallSurfaces surfaces;
  WallMeasures measures;
};

Measured measured(const VentricleCells& cells, bool tagged) {
  Measured out;
  DataSet mesh = ventricle_mesh(out.shape, cells);
  std::erase_if(mesh.arrays, [&](const DataArray& array) { return !tagged || array.name != kSurfaceArray; });
  out.grid = make_field_grid(std::span(&mesh, 1), "ventricle", 1);
  out.surfaces = find_wall_surfaces(*out.grid, mesh, "ventricle");
  out.measures = measure_wall(*out.grid, out.surfaces,
                              solve_laplace(*out.grid->tets, depths_on(out.surfaces), "ventricle", 1).values);
  return out;
}

TEST(WallMeasures, AreasAreThoseOfTheTruncatedEllipsoids) {
  for (const bool tagged : {true, false}) {
    const Measured found = measured({.wall = 6, .along = 28, .around = 72}, tagged);
    const auto area = [&](BorderRole role) { return found.surfaces.areas[as_size(role)]; };
    // Chords of 5 degrees around and as long ones along: each loses some 2e-3 of the curved surface.
    constexpr double kChords = 5e-3;
    EXPECT_NEAR(area(BorderRole::kInner) / area_of_layer(found.shape, found.shape.lambda_inner), 1.0,
                kChords);
    EXPECT_NEAR(area(BorderRole::kOuter) / area_of_layer(found.shape, found.shape.lambda_outer), 1.0,
                kChords);
    EXPECT_NEAR(area(BorderRole::kBase) / area_of_base(found.shape), 1.0, kChords);
    for (const BorderRole role : {BorderRole::kInner, BorderRole::kOuter, BorderRole::kBase})
      EXPECT_EQ(found.surfaces.pieces[as_size(role)], 1U) << name_of(role);
    EXPECT_EQ(found.surfaces.confidence, 1.0);
    EXPECT_EQ(found.measures.monotone, 1.0);
  }
}

TEST(WallMeasures, ThicknessIsTheLengthOfTheLinesThroughTheWall) {
  std::vector<double> worst;
  for (const int n : {1, 2, 3}) {
    const Measured found = measured({.wall = 3 * n, .along = 14 * n, .around = 36 * n}, false);
    worst.push_back(0.0);
    double thinnest = 1e300, thickest = 0.0;
    for (std::size_t p = 0; p < found.measures.thickness.size(); ++p) {
      const Prolate at =
          found.shape.coordinates(found.grid->frame.data_from_local(found.grid->tets->points()[p]));
      const double exact = thickness_at(found.shape, at.mu);
      worst.back() = std::max(worst.back(), std::abs(found.measures.thickness[p] / exact - 1.0));
      thinnest = std::min(thinnest, exact);
      thickest = std::max(thickest, exact);
    }
    EXPECT_NEAR(found.measures.thinnest / thinnest, 1.0, 2.0 * worst.back());
    EXPECT_NEAR(found.measures.thickest / thickest, 1.0, 2.0 * worst.back());
    EXPECT_GT(found.measures.median, found.measures.thinnest);
  }
  EXPECT_LT(worst[2], 0.02);
  EXPECT_LT(worst[2], 0.6 * worst[0]);
}

// A depth with a hollow in the wall is not monotone there, and the share says so.
TEST(WallMeasures, AHollowInTheDepthIsSeen) {
  Measured found = measured({.wall = 6, .along = 14, .around = 36}, true);
  WallPotential depth = solve_laplace(*found.grid->tets, depths_on(found.surfaces), "ventricle", 1);
  for (std::size_t p = 0; p < depth.values.size(); ++p) {
    const Prolate at =
        found.shape.coordinates(found.grid->frame.data_from_local(found.grid->tets->points()[p]));
    if (std::abs(at.lambda - 0.65) < 0.01 && at.mu > 1.0)
      depth.values[p] = 0.05;  // half way through the wall
  }
  const double share = measure_wall(*found.grid, found.surfaces, depth.values).monotone;
  EXPECT_LT(share, 0.95);
  EXPECT_GT(share, 0.3);
}

// On linear values every way is straight: a cube between two planes.
TEST(WayLengths, AreExactBetweenPlanes) {
  std::vector<Vec3> points;
  std::vector<TetMesh::Tet> cells;
  constexpr int kSide = 3;
  const auto at = [](int i, int j, int k) {
    return static_cast<std::uint32_t>((i * (kSide + 1) + j) * (kSide + 1) + k);
  };
  for (int i = 0; i <= kSide; ++i)
    for (int j = 0; j <= kSide; ++j)
      for (int k = 0; k <= kSide; ++k) points.emplace_back(i, j, k);
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j)
      for (int k = 0; k < kSide; ++k)
        for (const auto& [a, b] : std::vector<std::pair<Vec3, Vec3>>{{{1, 0, 0}, {1, 1, 0}},
                                                                     {{1, 0, 0}, {1, 0, 1}},
                                                                     {{0, 1, 0}, {1, 1, 0}},
                                                                     {{0, 1, 0}, {0, 1, 1}},
                                                                     {{0, 0, 1}, {1, 0, 1}},
                                                                     {{0, 0, 1}, {0, 1, 1}}})
          cells.push_back({at(i, j, k), at(i + int(a.x), j + int(a.y), k + int(a.z)),
                           at(i + int(b.x), j + int(b.y), k + int(b.z)), at(i + 1, j + 1, k + 1)});
  const TetMesh mesh(points, cells);
  std::vector<double> heights;
  for (const Vec3& x : mesh.points()) heights.push_back(x.z);
  const std::vector<double> down = way_lengths(mesh, heights, WayAlong::kFalling),
                            up = way_lengths(mesh, heights, WayAlong::kRising);
  for (std::size_t p = 0; p < heights.size(); ++p) {
    EXPECT_NEAR(down[p], heights[p], 1e-12);
    EXPECT_NEAR(up[p], kSide - heights[p], 1e-12);
  }
  // What no value reaches has no way.
  heights[at(1, 1, 1)] = std::nan("");
  EXPECT_TRUE(std::isnan(way_lengths(mesh, heights, WayAlong::kFalling)[at(1, 1, 1)]));
}

}  // namespace
}  // namespace palpate
