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

// The base has no say, so that layers are those of the mesh that names its surfaces.
TEST(WallSurfacesByShape, RimsOfAnyShapeStayFree) {
  std::mt19937 random(23);
  std::uniform_real_distribution<double> any(-0.5, 0.5);
  std::map<int, double> jags;
  for (int n = -20; n <= 20; ++n) jags[n] = any(random);
  const std::map<std::string, std::function<double(double)>> rims{
      {"slanted", [](double theta) { return 0.5 * std::cos(theta); }},
      {"saddle", [](double theta) { return 0.5 * std::cos(2.0 * theta); }},
      {"three lobes", [](double theta) { return 0.5 * std::sin(3.0 * theta); }},
      {"teeth", [](double theta) { return std::lround(theta * 18.0 / kPi) % 2 == 0 ? 0.5 : -0.5; }},
      {"jagged", [&](double theta) { return jags.at(static_cast<int>(std::lround(theta * 18.0 / kPi))); }}};
  for (const auto& [name, rim] : rims) {
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
    EXPECT_GT(septum, 40U) << degrees;
    EXPECT_EQ(rising, columns) << degrees;
    EXPECT_EQ(right_rising, right) << degrees;
  }
}

}  // namespace
}  // namespace palpate
