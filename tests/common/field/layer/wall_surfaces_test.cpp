// Surfaces of walls by their shape: rims that are not flat, two ventricles. What is right is known from how each
// mesh was made.
#include "common/field/layer/wall_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/ventricle.h"
#include "common/field/field_grid.h"
#include "common/field/layer/wall_layer.h"
#include "tests/support/two_ventricles.h"
#include "tests/support/zone_mesh.h"

namespace palpate {
namespace {

constexpr double kPi = std::numbers::pi;

/// A ventricle whose points above half its height are moved along its axis: by `rim` of its angle at the base.
/// @param rim in parts of the height. @param tags whether the mesh says what its surfaces are.
DataSet with_rim(const std::function<double(double)>& rim, bool tags, double mu_base) {
  Ventricle shape;
  shape.mu_base = mu_base;
  DataSet mesh = ventricle_mesh(shape, {.wall = 4, .along = 14, .around = 36});
  auto& topology = std::get<UnstructuredTopology>(mesh.topology);
  std::vector<double> x;
  double low = 0.0, high = -1e300;
  for (std::size_t p = 0; p < topology.positions.tuples; ++p) {
    low = std::min(low, topology.positions.at(p, 2));
    high = std::max(high, topology.positions.at(p, 2));
  }
  const double height = high - low;
  for (std::size_t p = 0; p < topology.positions.tuples; ++p) {
    const Vec3 at{topology.positions.at(p, 0), topology.positions.at(p, 1), topology.positions.at(p, 2)};
    const Prolate place = shape.coordinates(at);
    const double part = std::max(0.0, 2.0 * place.mu / mu_base - 1.0);
    x.insert(x.end(), {at.x, at.y, at.z + height * part * part * rim(place.theta)});
  }
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(x));
  std::erase_if(mesh.arrays, [&](const DataArray& array) { return !tags || array.name != kSurfaceArray; });
  return mesh;
}

std::string text_of(const WallLayer& layer) {
  std::string text;
  for (const std::string& note : layer.notes) text += note + "\n";
  return text;
}

/// By the angle around, from -0.5 to 0.5; 36 points around.
std::map<std::string, std::function<double(double)>> rims() {
  std::mt19937 random(23);
  std::uniform_real_distribution<double> any(-0.5, 0.5);
  std::map<int, double> jags;
  for (int n = -20; n <= 20; ++n) jags[n] = any(random);
  return {{"slanted", [](double theta) { return 0.5 * std::cos(theta); }},
          {"saddle", [](double theta) { return 0.5 * std::cos(2.0 * theta); }},
          {"three lobes", [](double theta) { return 0.5 * std::sin(3.0 * theta); }},
          {"teeth", [](double theta) { return std::lround(theta * 18.0 / kPi) % 2 == 0 ? 0.5 : -0.5; }},
          {"jagged",
           [jags](double theta) { return jags.at(static_cast<int>(std::lround(theta * 18.0 / kPi))); }}};
}

// A rim that goes straight through the wall lets the potential between two ellipsoids of one pair of foci be, whatever
// its shape: nothing of its gradient leads through it.
TEST(WallSurfacesByShape, DepthsOfWallsWithAnyRimAreTheClosedForm) {
  const Ventricle shape;
  const double inner = shape.potential(shape.lambda_inner), outer = shape.potential(shape.lambda_outer);
  for (const auto& [name, rim] : rims()) {
    for (const double size : {0.0, 0.06, 0.12, 0.2}) {
      // The height from the apex to a base at mu: the cosine falls by twice as much from 0 to pi.
      const auto place = [&, &each = rim](double s, double t, double angle) {
        const double high = 1.0 - std::cos(shape.mu_base);
        const double mu =
            t * std::acos(std::clamp(1.0 - high * (1.0 + size * each(std::remainder(angle, 2.0 * kPi))), -1.0,
                                     1.0));
        return shape.position(
            {shape.lambda_inner + s * (shape.lambda_outer - shape.lambda_inner), mu, angle});
      };
      const WallLayer layer =
          make_wall_layer(test::zone_mesh(place, {.wall = 6, .along = 20, .around = 36}, true), "heart");
      EXPECT_EQ(text_of(layer).find("WARNING"), std::string::npos) << name << size << text_of(layer);
      const std::size_t through = layer.array.tuples / 7;
      double worst = 0.0, falls = -1.0;
      for (std::size_t p = 0; p < layer.array.tuples; ++p) {
        const double lambda = shape.lambda_inner + static_cast<double>(p / through) / 6.0 *
                                                       (shape.lambda_outer - shape.lambda_inner);
        worst = std::max(worst,
                         std::abs(layer.array.at(p) - (shape.potential(lambda) - inner) / (outer - inner)));
        if (p >= through) falls = std::max(falls, layer.array.at(p - through) - layer.array.at(p));
      }
      RecordProperty("worst_" + name + "_" + std::to_string(size), std::to_string(worst));
      // Cells lean where the rim is jagged.
      EXPECT_LT(worst, 0.02 + 0.35 * size) << name << " " << size;
      EXPECT_LT(falls, 0.0) << name << " " << size << ": the depth rises through the wall everywhere";
    }
  }
}

// The base has no say, so that layers are those of the mesh that names its surfaces.
TEST(WallSurfacesByShape, RimsOfAnyShapeStayFree) {
  for (const auto& [name, rim] : rims()) {
    for (const double mu_base : {0.5 * kPi, 1.9}) {
      for (const double size : {0.0, 0.06, 0.12, 0.2}) {
        const auto scaled = [size, &shape = rim](double theta) { return size * shape(theta); };
        const WallLayer found = make_wall_layer(with_rim(scaled, false, mu_base), "heart");
        const WallLayer named = make_wall_layer(with_rim(scaled, true, mu_base), "heart");
        double worst = 0.0;
        for (std::size_t p = 0; p < found.array.tuples; ++p)
          worst = std::max(worst, std::abs(found.array.at(p) - named.array.at(p)));
        EXPECT_LT(worst, 1e-6) << name << " " << size << " " << mu_base << "\n" << text_of(found);
      }
    }
  }
}

/// Areas of triangles, by what they are: all points inside, all outside, others.
struct Found {
  double wrong = 0.0, all = 0.0;
  std::string notes;
};

Found found_on(const DataSet& mesh, int layers) {
  const auto grid = make_field_grid(std::span(&mesh, 1), "wall", 0);
  const WallSurfaces surfaces = find_wall_surfaces(*grid, mesh, "wall");
  // Points are numbered through the wall last.
  const std::size_t layer = mesh.point_count() / (static_cast<std::size_t>(layers) + 1);
  std::vector<std::size_t> input(grid->point_count());
  for (std::size_t i = 0; i < mesh.point_count(); ++i)
    input[grid->point_of_input.empty() ? i : grid->point_of_input[i]] = i;
  Found found;
  for (const std::string& note : notes_of(surfaces)) found.notes += note + "\n";
  const auto points = grid->tets->points();
  for (std::size_t t = 0; t < surfaces.triangles.size(); ++t) {
    const auto& corners = surfaces.triangles[t];
    const auto all = [&](std::size_t of) {
      return std::ranges::all_of(corners, [&](auto corner) { return input[corner] / layer == of; });
    };
    const BorderRole role = all(0)                                  ? BorderRole::kInner
                            : all(static_cast<std::size_t>(layers)) ? BorderRole::kOuter
                                                                    : BorderRole::kBase;
    const glm::dvec3 origin = points[corners[0]];
    const double area = glm::length(glm::cross(points[corners[1]] - origin, points[corners[2]] - origin));
    found.all += area;
    if (surfaces.roles[t] != role) found.wrong += area;
  }
  return found;
}

// Walls with one opening or two, whose rims are flat, slanted, wavy, or cones that face away from the axis.
TEST(WallSurfacesByShape, RimsOfBothOpeningsAreRimsWhicheverWayTheyFace) {
  const auto sphere = [](double from, double to, double inner = 20.0,
                         double outer = 30.0) -> test::ZonePlace {
    return [=](double s, double t, double angle) {
      return test::on_sphere(inner + (outer - inner) * s, (from + (to - from) * t) * kPi / 180.0, angle);
    };
  };
  const auto tube = [](double half, const std::function<double(double, double)>& low,
                       const std::function<double(double, double)>& high) -> test::ZonePlace {
    return [=](double s, double t, double angle) {
      const double r = 20.0 + 10.0 * s, z0 = -half + low(s, angle), z1 = half + high(s, angle);
      return Vec3{r * std::cos(angle), r * std::sin(angle), z0 + (z1 - z0) * t};
    };
  };
  const auto flat = [](double, double) { return 0.0; };
  const auto slant = [](double, double angle) { return 8.0 * std::cos(angle); };
  const auto wave = [](double, double angle) { return 5.0 * std::cos(2.0 * angle); };
  const auto cone = [](double s, double) { return 4.0 * s; };
  const auto back = [](double s, double) { return -4.0 * s; };
  struct Case {
    std::string name;
    test::ZonePlace place;
    bool pole;
  };
  const std::vector<Case> cases{{"hole at the apex", sphere(20.0, 100.0), false},
                                {"large hole", sphere(45.0, 100.0), false},
                                {"ring", sphere(70.0, 100.0), false},
                                {"thin ring", sphere(60.0, 110.0, 27.0, 30.0), false},
                                {"cup", sphere(0.0, 60.0), true},
                                {"shallow cup", sphere(0.0, 40.0), true},
                                {"half", sphere(0.0, 90.0), true},
                                {"nearly closed", sphere(0.0, 150.0), true},
                                {"all but closed", sphere(0.0, 168.0), true},
                                {"tube", tube(20.0, flat, flat), false},
                                {"slanted tube", tube(20.0, slant, slant), false},
                                {"wedge", tube(20.0, slant, flat), false},
                                {"wavy tube", tube(20.0, wave, wave), false},
                                {"one wavy rim", tube(20.0, wave, flat), false},
                                {"bevelled tube", tube(20.0, back, cone), false},
                                {"hollowed tube", tube(20.0, cone, back), false},
                                {"short bevelled tube", tube(8.0, back, cone), false}};
  for (const auto& [name, place, pole] : cases) {
    const Found found = found_on(test::zone_mesh(place, {}, pole), 4);
    EXPECT_LT(found.wrong, 1e-9 * found.all) << name << "\n" << found.notes;
    EXPECT_EQ(found.notes.find("WARNING"), std::string::npos) << name << "\n" << found.notes;
  }
}

/// A block of cubes with cavities, boxes [from, to) of cubes; open where they reach its top.
DataSet block_with(const Index3& n, const std::vector<std::pair<Index3, Index3>>& cavities) {
  std::vector<double> x;
  for (int k = 0; k <= n.z; ++k)
    for (int j = 0; j <= n.y; ++j)
      for (int i = 0; i <= n.x; ++i) x.insert(x.end(), {1.0 * i, 1.0 * j, 1.0 * k});
  UnstructuredTopology topology;
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(x));
  topology.offsets.push_back(0);
  for (int k = 0; k < n.z; ++k)
    for (int j = 0; j < n.y; ++j)
      for (int i = 0; i < n.x; ++i) {
        const bool hollow = std::ranges::any_of(cavities, [&](const auto& box) {
          const auto& [a, b] = box;
          return i >= a.x && i < b.x && j >= a.y && j < b.y && k >= a.z && k < b.z;
        });
        if (hollow) continue;
        for (const auto& [u, v, w] : std::array<std::array<int, 3>, 8>{
                 {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}})
          topology.connectivity.push_back(((k + w) * (n.y + 1) + j + v) * (n.x + 1) + i + u);
        topology.offsets.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
        topology.types.push_back(12);
      }
  DataSet mesh;
  mesh.topology = std::move(topology);
  return mesh;
}

// Nothing of such a wall is curved: its edges say which sides are whose. Areas are those of the boxes.
TEST(WallSurfacesByShape, CavitiesWithFlatSidesAreTheBoxes) {
  struct Case {
    std::string name;
    Index3 n;
    std::vector<std::pair<Index3, Index3>> cavities;
    double inner, outer, base, right, septum;
  };
  const std::vector<Case> cases{
      {"open box", {8, 8, 6}, {{{2, 2, 2}, {6, 6, 6}}}, 16.0 + 64.0, 64.0 + 192.0, 48.0, 0.0, 0.0},
      {"closed box", {8, 8, 8}, {{{2, 2, 2}, {6, 6, 6}}}, 96.0, 384.0, 0.0, 0.0, 0.0},
      {"deep well", {6, 6, 12}, {{{2, 2, 2}, {4, 4, 12}}}, 4.0 + 80.0, 36.0 + 288.0, 32.0, 0.0, 0.0},
      // The left one is the rounder: 4 x 4 x 5 beside 2 x 4 x 5; the wall between is two thick.
      {"two boxes",
       {12, 8, 7},
       {{{2, 2, 2}, {6, 6, 7}}, {{8, 2, 2}, {10, 6, 7}}},
       16.0 + 80.0,
       96.0 + 280.0,
       96.0 - 16.0 - 8.0,
       8.0 + 20.0 + 20.0,
       20.0}};
  for (const auto& [name, n, cavities, inner, outer, base, right, septum] : cases) {
    const DataSet mesh = block_with(n, cavities);
    const auto grid = make_field_grid(std::span(&mesh, 1), "box", 1);
    const WallSurfaces found = find_wall_surfaces(*grid, mesh, "box");
    const auto area = [&, &surfaces = found](BorderRole role) {
      return surfaces.areas[static_cast<std::size_t>(role)];
    };
    EXPECT_NEAR(area(BorderRole::kInner), inner, 1e-9) << name << found.note;
    EXPECT_NEAR(area(BorderRole::kOuter), outer, 1e-9) << name << found.note;
    EXPECT_NEAR(area(BorderRole::kBase), base, 1e-9) << name << found.note;
    EXPECT_NEAR(area(BorderRole::kSeptum) + area(BorderRole::kRight), right + septum, 1e-9)
        << name << found.note;
    EXPECT_NEAR(area(BorderRole::kSeptum), septum, 1e-9) << name << found.note;
    for (const std::string& doubt : found.doubts) ADD_FAILURE() << name << ": " << doubt;
  }
}

TEST(WallSurfacesByShape, TheSeptumRunsFromOneVentricleToTheOther) {
  for (const double degrees : {70.0, 90.0, 110.0, 130.0, 150.0, 170.0}) {
    const test::TwoVentricles heart(degrees * kPi / 180.0);
    const WallLayer layer = make_wall_layer(heart.mesh, "heart");
    const std::string notes = text_of(layer);
    EXPECT_NE(notes.find("septum on the right"), std::string::npos) << degrees << notes;
    EXPECT_EQ(notes.find("WARNING"), std::string::npos) << degrees << notes;
    std::size_t columns = 0, rising = 0, septum = 0, right = 0, right_rising = 0;
    for (int i = 0; i < test::TwoVentricles::kAround; ++i) {
      for (int j = 1; j < test::TwoVentricles::kAlong; ++j) {
        const auto rises = [&](int wall) {
          bool up = heart.depth(layer, wall, i, j, 0) == 0.0;
          for (int k = 1; k <= test::TwoVentricles::kThrough; ++k)
            up = up && heart.depth(layer, wall, i, j, k) > heart.depth(layer, wall, i, j, k - 1);
          return up && heart.depth(layer, wall, i, j, test::TwoVentricles::kThrough) == 1.0;
        };
        if (heart.gap_at(i, j) > 0.0) {
          ++septum;
          EXPECT_TRUE(rises(0)) << degrees << " septum " << i << " " << j;
          ++right;
          right_rising += rises(1) ? 1 : 0;
        }
        // Where the right wall stands on the left one the wall goes on.
        ++columns;
        rising += heart.depth(layer, 0, i, j, 0) == 0.0 && heart.depth(layer, 0, i, j, 1) > 0.0 ? 1 : 0;
      }
    }
    RecordProperty("rising_of_columns_at_" + std::to_string(degrees),
                   std::to_string(rising) + " of " + std::to_string(columns) + ", behind the septum " +
                       std::to_string(right_rising) + " of " + std::to_string(right));
    EXPECT_GT(septum, 40U) << degrees;
    EXPECT_EQ(rising, columns) << degrees;
    EXPECT_EQ(right_rising, right) << degrees;
  }
}

}  // namespace
}  // namespace palpate
