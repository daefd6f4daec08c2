// Coordinates of the wall on the analytic ventricle against closed forms, and of two ventricles.
#include "common/field/layer/wall_coordinates.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/analytic/ventricle.h"
#include "tests/support/two_ventricles.h"

namespace palpate {
namespace {

constexpr double kPi = std::numbers::pi;

struct Found {
  Ventricle shape;
  DataSet mesh;
  std::shared_ptr<const FieldGrid> grid;
  WallCoordinates made;
};

Found coordinates_of(const VentricleCells& cells) {
  Found out;
  out.mesh = ventricle_mesh(out.shape, cells);
  out.mesh.arrays.clear();  // by shape
  out.grid = make_field_grid(std::span(&out.mesh, 1), "ventricle", 1);
  out.made =
      make_wall_coordinates(*out.grid, find_wall_surfaces(*out.grid, out.mesh, "ventricle"), "ventricle", 1);
  return out;
}

/// Length of the curve of constant lambda and theta from the apex to `mu` [mm]: Simpson's rule.
double along(const Ventricle& shape, double lambda, double mu) {
  constexpr int kParts = 200;
  const auto speed = [&](double m) { return shape.focus * std::hypot(std::sinh(lambda), std::sin(m)); };
  double sum = 0.0;
  for (int i = 0; i < kParts; ++i) {
    const double a = mu * i / kParts, b = mu * (i + 1) / kParts;
    sum += (b - a) / 6.0 * (speed(a) + 4.0 * speed(0.5 * (a + b)) + speed(b));
  }
  return sum;
}

struct Worst {
  double transmural = 0.0, apicobasal = 0.0, rotational = 0.0;
};

Worst worst_of(const Found& found) {
  Worst worst;
  const double inner = found.shape.potential(found.shape.lambda_inner),
               outer = found.shape.potential(found.shape.lambda_outer);
  for (std::size_t p = 0; p < found.grid->tets->points().size(); ++p) {
    const Prolate at =
        found.shape.coordinates(found.grid->frame.data_from_local(found.grid->tets->points()[p]));
    const double depth = (found.shape.potential(at.lambda) - inner) / (outer - inner);
    worst.transmural = std::max(worst.transmural, std::abs(found.made.transmural[p] - depth));
    const double height =
        along(found.shape, at.lambda, at.mu) / along(found.shape, at.lambda, found.shape.mu_base);
    worst.apicobasal = std::max(worst.apicobasal, std::abs(found.made.apicobasal[p] - height));
    if (at.mu > 1e-6)
      worst.rotational = std::max(worst.rotational,
                                  std::abs(std::remainder(found.made.rotational[p] - at.theta, 2.0 * kPi)));
  }
  return worst;
}

TEST(WallCoordinates, ConvergeToTheClosedFormsOfTheVentricle) {
  std::vector<Worst> worst;
  for (const int n : {1, 2, 3}) {
    worst.push_back(worst_of(coordinates_of({.wall = 3 * n, .along = 14 * n, .around = 36 * n})));
  }
  EXPECT_LT(worst[2].transmural, 0.005);
  EXPECT_LT(worst[2].transmural, 0.3 * worst[0].transmural);
  EXPECT_LT(worst[2].apicobasal, 0.02);
  EXPECT_LT(worst[2].apicobasal, 0.6 * worst[0].apicobasal);
  for (const Worst& each : worst) EXPECT_LT(each.rotational, 1e-6);
}

TEST(WallCoordinates, StayInTheirRanges) {
  const Found found = coordinates_of({.wall = 4, .along = 20, .around = 48});
  std::size_t on_axis = 0;
  for (std::size_t p = 0; p < found.made.transmural.size(); ++p) {
    EXPECT_GE(found.made.transmural[p], 0.0);
    EXPECT_LE(found.made.transmural[p], 1.0);
    EXPECT_GE(found.made.apicobasal[p], 0.0);
    EXPECT_LE(found.made.apicobasal[p], 1.0);
    if (std::isnan(found.made.rotational[p])) {
      ++on_axis;
      continue;
    }
    EXPECT_GT(found.made.rotational[p], -kPi);
    EXPECT_LE(found.made.rotational[p], kPi);
  }
  EXPECT_EQ(on_axis, 5U);  // through the wall at the apex
  EXPECT_TRUE(found.made.ventricle.empty());
}

// From the apex to the base along any line of the mesh the coordinate rises; through the wall the depth does.
TEST(WallCoordinates, AreMonotone) {
  const Found found = coordinates_of({.wall = 4, .along = 20, .around = 48});
  std::vector<std::pair<Prolate, std::size_t>> points;
  for (std::size_t p = 0; p < found.made.transmural.size(); ++p)
    points.emplace_back(
        found.shape.coordinates(found.grid->frame.data_from_local(found.grid->tets->points()[p])), p);
  const auto near = [](double a, double b) { return std::abs(a - b) < 1e-6; };
  std::size_t pairs = 0;
  for (const auto& [a, p] : points) {
    for (const auto& [b, q] : points) {
      if (!near(a.theta, b.theta) || p == q) continue;
      if (near(a.lambda, b.lambda) && a.mu + 1e-6 < b.mu) {
        EXPECT_LT(found.made.apicobasal[p], found.made.apicobasal[q]) << a.mu << " " << b.mu;
        ++pairs;
      }
      if (near(a.mu, b.mu) && a.lambda + 1e-6 < b.lambda) {
        EXPECT_LT(found.made.transmural[p], found.made.transmural[q]) << a.lambda << " " << b.lambda;
        ++pairs;
      }
    }
  }
  EXPECT_GT(pairs, 1000U);
}

// A ventricle that is turned and moved has the same coordinates but for where the angle begins.
TEST(WallCoordinates, TurnWithTheHeart) {
  Ventricle shape;
  DataSet mesh = ventricle_mesh(shape, {.wall = 3, .along = 14, .around = 36});
  mesh.arrays.clear();
  const auto made_of = [](const DataSet& data) {
    const auto grid = make_field_grid(std::span(&data, 1), "ventricle", 1);
    return make_wall_coordinates(*grid, find_wall_surfaces(*grid, data, "ventricle"), "ventricle", 1);
  };
  const WallCoordinates straight = made_of(mesh);
  auto& positions = std::get<UnstructuredTopology>(mesh.topology).positions;
  const Vec3 e0 = glm::normalize(Vec3{1.0, 2.0, -0.5}),
             e2 = glm::normalize(glm::cross(e0, Vec3{0.3, 1.0, 2.0}));
  const Mat3 turn{e0, glm::cross(e2, e0), e2};
  std::vector<double> moved;
  for (std::size_t p = 0; p < positions.tuples; ++p) {
    const Vec3 x =
        turn * Vec3{positions.at(p, 0), positions.at(p, 1), positions.at(p, 2)} + Vec3{300.0, -40.0, 7.0};
    moved.insert(moved.end(), {x.x, x.y, x.z});
  }
  positions = make_array("points", Association::kPoint, 3, std::span<const double>(moved));
  const WallCoordinates turned = made_of(mesh);
  EXPECT_NEAR(glm::dot(turned.axis.direction, turn * straight.axis.direction), 1.0, 1e-9);
  double shift = 0.0, worst = 0.0;
  for (std::size_t p = 0; p < straight.transmural.size(); ++p) {
    EXPECT_NEAR(turned.transmural[p], straight.transmural[p], 1e-5);
    EXPECT_NEAR(turned.apicobasal[p], straight.apicobasal[p], 1e-4);
    if (std::isnan(straight.rotational[p])) continue;
    const double by = std::remainder(turned.rotational[p] - straight.rotational[p], 2.0 * kPi);
    if (shift == 0.0) shift = by;
    worst = std::max(worst, std::abs(std::remainder(by - shift, 2.0 * kPi)));
  }
  EXPECT_LT(worst, 1e-6);
}

// The septum is the left ventricle's and runs from 0 to 1; the right one's free wall is its own. The angle begins at
// the middle of the septum, which lies along x here.
TEST(WallCoordinates, TellTwoVentriclesApart) {
  for (const double degrees : {70.0, 110.0, 150.0}) {
    const test::TwoVentricles heart(degrees * kPi / 180.0);
    const auto grid = make_field_grid(std::span(&heart.mesh, 1), "heart", 1);
    const WallCoordinates made =
        make_wall_coordinates(*grid, find_wall_surfaces(*grid, heart.mesh, "heart"), "heart", 1);
    const auto at = [&](const std::vector<double>& values, int wall, int i, int j, int k) {
      const std::size_t p = heart.point_at(wall, i, j, k);
      return values[grid->point_of_input.empty() ? p : grid->point_of_input[p]];
    };
    // The left cavity is round about z, and so is its rim.
    EXPECT_NEAR(made.axis.direction.z, 1.0, 1e-3) << degrees;
    ASSERT_FALSE(made.ventricle.empty());
    constexpr int kThrough = test::TwoVentricles::kThrough;
    constexpr double kUneven = 0.06;  // of the septum's outline, which goes by triangles of 5 degrees
    for (int i = 0; i < test::TwoVentricles::kAround; ++i) {
      for (int j = 3; j < test::TwoVentricles::kAlong; ++j) {
        const double angle = std::remainder(2.0 * kPi * i / test::TwoVentricles::kAround, 2.0 * kPi);
        for (int k = 0; k <= kThrough; ++k)
          EXPECT_LT(std::abs(std::remainder(at(made.rotational, 0, i, j, k) - angle, 2.0 * kPi)), kUneven)
              << degrees;
        EXPECT_EQ(at(made.ventricle, 0, i, j, 1), -1.0) << degrees << " " << i << " " << j;
        if (!(heart.gap_at(i, j) > 0.0)) continue;
        EXPECT_EQ(at(made.transmural, 0, i, j, kThrough), 1.0);
        EXPECT_EQ(at(made.ventricle, 1, i, j, kThrough), 1.0) << degrees << " " << i << " " << j;
        EXPECT_EQ(at(made.transmural, 1, i, j, 0), 0.0);
      }
    }
  }
}

TEST(WallCoordinates, AClosedShellIsRefused) {
  Ventricle shape;
  shape.mu_base = 3.0;
  DataSet mesh = ventricle_mesh(shape, {.wall = 3, .along = 20, .around = 36});
  std::vector<double> tags;
  const auto& positions = std::get<UnstructuredTopology>(mesh.topology).positions;
  for (std::size_t p = 0; p < positions.tuples; ++p) {
    const Prolate at = shape.coordinates({positions.at(p, 0), positions.at(p, 1), positions.at(p, 2)});
    tags.push_back(at.lambda < 0.65 ? 1.0 : 2.0);  // no base: every point is of a surface
  }
  mesh.arrays = {make_array(kSurfaceArray, Association::kPoint, 1, std::span<const double>(tags))};
  const auto grid = make_field_grid(std::span(&mesh, 1), "shell.vtu", 1);
  const WallSurfaces surfaces = find_wall_surfaces(*grid, mesh, "shell.vtu");
  try {
    (void)make_wall_coordinates(*grid, surfaces, "shell.vtu", 1);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_NE(std::string(error.what()).find("no base"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace palpate
