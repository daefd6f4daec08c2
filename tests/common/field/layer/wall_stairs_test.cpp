// Surfaces of walls of voxels, whose borders are stairs, against the areas of the ellipsoids that they are made of.
#include "common/field/layer/wall_stairs.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/field_grid.h"
#include "common/field/layer/wall_layer.h"
#include "common/field/layer/wall_measures.h"
#include "common/field/layer/wall_surfaces.h"

namespace palpate {
namespace {

constexpr double kPi = std::numbers::pi;

struct Ellipsoid {
  Vec3 middle, axes;

  [[nodiscard]] bool holds(const Vec3& x) const {
    const Vec3 part = (x - middle) / axes;
    return glm::dot(part, part) <= 1.0;
  }
  /// The area of what `counts`, by the midpoints of 400 x 800 patches.
  [[nodiscard]] double area(const std::function<bool(const Vec3&)>& counts) const {
    constexpr int kPolar = 400, kRound = 800;
    double sum = 0.0;
    for (int i = 0; i < kPolar; ++i)
      for (int j = 0; j < kRound; ++j) {
        const double polar = kPi * (i + 0.5) / kPolar, round = 2.0 * kPi * (j + 0.5) / kRound;
        const Vec3 unit{std::sin(polar) * std::cos(round), std::sin(polar) * std::sin(round),
                        std::cos(polar)};
        if (!counts(middle + axes * unit)) continue;
        // Of the unit sphere times det(A) |A^-1 n|.
        sum += axes.x * axes.y * axes.z * glm::length(unit / axes) * std::sin(polar) * (kPi / kPolar) *
               (2.0 * kPi / kRound);
      }
    return sum;
  }
};

/// Voxels whose middles `holds`, turned by `turn`.
DataSet voxels(const std::function<bool(const Vec3&)>& holds, const Vec3& low, const Vec3& high, double size,
               const Mat3& turn = Mat3{1.0}) {
  std::map<std::array<int, 3>, std::int64_t> number;
  std::vector<double> x;
  UnstructuredTopology topology;
  topology.offsets.push_back(0);
  const auto point = [&](int i, int j, int k) {
    const auto [found, is_new] = number.try_emplace({i, j, k}, static_cast<std::int64_t>(number.size()));
    if (is_new) {
      const Vec3 at = turn * (low + size * Vec3{i, j, k});
      x.insert(x.end(), {at.x, at.y, at.z});
    }
    return found->second;
  };
  const Vec3 count = glm::ceil((high - low) / size);
  for (int k = 0; k < static_cast<int>(count.z); ++k)
    for (int j = 0; j < static_cast<int>(count.y); ++j)
      for (int i = 0; i < static_cast<int>(count.x); ++i) {
        if (!holds(low + size * Vec3{i + 0.5, j + 0.5, k + 0.5})) continue;
        for (const int up : {k, k + 1})
          for (const auto& [a, b] : std::array<std::array<int, 2>, 4>{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}})
            topology.connectivity.push_back(point(i + a, j + b, up));
        topology.types.push_back(12);
        topology.offsets.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
      }
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(x));
  DataSet mesh;
  mesh.topology = std::move(topology);
  return mesh;
}

struct Found {
  WallSurfaces surfaces;
  WallMeasures measures;
  std::string notes;
  [[nodiscard]] double area(BorderRole role) const { return surfaces.areas[static_cast<std::size_t>(role)]; }
};

Found found_on(const DataSet& mesh) {
  const auto grid = make_field_grid(std::span(&mesh, 1), "wall", 0);
  Found found{.surfaces = find_wall_surfaces(*grid, mesh, "wall"), .measures = {}, .notes = {}};
  for (const std::string& note : notes_of(found.surfaces)) found.notes += note + "\n";
  const WallLayer layer = make_wall_layer(*grid, mesh, "wall");
  std::vector<double> depth(grid->point_count());
  for (std::size_t i = 0; i < layer.array.tuples; ++i)
    depth[grid->point_of_input.empty() ? i : grid->point_of_input[i]] = layer.array.at(i);
  found.measures = measure_wall(*grid, found.surfaces, depth);
  return found;
}

const Ellipsoid kInside{{0.0, 0.0, 0.0}, {20.0, 20.0, 50.0}}, kOutside{{0.0, 0.0, 0.0}, {30.0, 30.0, 60.0}};

/// Half of a plane through the middle is half of the ellipsoid.
struct Cut {
  std::string name;
  Vec3 up;
};

TEST(WallStairs, SurfacesOfAVentricleAreThoseOfItsEllipsoids) {
  const Vec3 e0 = glm::normalize(Vec3{1.0, 2.0, -0.5}),
             e2 = glm::normalize(glm::cross(e0, Vec3{0.3, 1.0, 2.0}));
  const Mat3 turn{e0, glm::cross(e2, e0), e2};
  for (const auto& [name, up] :
       {Cut{"flat", {0.0, 0.0, 1.0}}, Cut{"slanted", {-0.3, 0.0, 1.0}}, Cut{"turned", {0.1, 0.2, 1.0}}}) {
    const auto below = [&up = up](const Vec3& x) { return glm::dot(x, up) < 0.0; };
    const double inner = kInside.area(below), outer = kOutside.area(below);
    // A section through the middle, by its half axes along and across the slope.
    const auto section = [&up = up](const Ellipsoid& body) {
      const Vec3 normal = glm::normalize(up);
      return kPi * body.axes.x * body.axes.y * body.axes.z / glm::length(normal * body.axes);
    };
    const double base = section(kOutside) - section(kInside);
    for (const double size : {4.0, 2.5, 1.6}) {
      if (name != "flat" && size != 2.5) continue;
      const Found found = found_on(voxels(
          [&](const Vec3& x) { return below(x) && kOutside.holds(x) && !kInside.holds(x); },
          Vec3{-32.0, -32.0, -62.0}, Vec3{32.0, 32.0, 14.0}, size, name == "turned" ? turn : Mat3{1.0}));
      const std::string what = name + " " + std::to_string(size) + "\n" + found.notes;
      const auto off = [&](BorderRole role, double truth) {
        return std::abs(found.area(role) / truth - 1.0);
      };
      // Known to a voxel along the rims, which are as long as a section is round.
      EXPECT_LT(off(BorderRole::kInner, inner), size * 2.0 * kPi * 20.0 / inner) << what;
      EXPECT_LT(off(BorderRole::kOuter, outer), size * 2.0 * kPi * 30.0 / outer) << what;
      EXPECT_LT(off(BorderRole::kBase, base), size * 2.0 * kPi * 50.0 / base) << what;
      EXPECT_NE(found.notes.find("border is stairs"), std::string::npos) << what;
      EXPECT_EQ(found.notes.find("piece"), std::string::npos) << what;
      EXPECT_GT(found.measures.monotone, 0.99) << what;
      // 10 at every place of the wall along the axes.
      EXPECT_NEAR(found.measures.median, 10.0, size) << what;
    }
  }
}

// The right ventricle's cavity lies between its wall and the left one, whose outer side there is the septum's.
TEST(WallStairs, TheSeptumOfTwoVentriclesIsFound) {
  const auto below = [](const Vec3& x) { return x.z < 0.0; };
  const double inner = kInside.area(below);
  // The farther out the cavity, the less of it is septum: 35, 27 and 20 %.
  for (const auto& [out, size] :
       std::vector<std::pair<double, double>>{{22.0, 2.5}, {22.0, 1.6}, {32.0, 2.5}, {40.0, 2.5}}) {
    const Ellipsoid cavity{{out, 0.0, 0.0}, {30.0, 26.0, 44.0}}, wall{{out, 0.0, 0.0}, {35.0, 31.0, 49.0}};
    const double septum = kOutside.area([&](const Vec3& x) { return below(x) && cavity.holds(x); });
    const Found found = found_on(voxels(
        [&](const Vec3& x) {
          if (!below(x)) return false;
          const bool left = kOutside.holds(x);
          return left ? !kInside.holds(x) : wall.holds(x) && !cavity.holds(x);
        },
        Vec3{-32.0, -34.0, -62.0}, Vec3{out + 38.0, 34.0, 4.0}, size));
    const std::string what = std::to_string(out) + " " + std::to_string(size) + "\n" + found.notes +
                             std::to_string(found.area(BorderRole::kSeptum) / found.area(BorderRole::kRight));
    EXPECT_NEAR(found.area(BorderRole::kSeptum) / septum, 1.0, 0.07 * size) << what;
    EXPECT_NEAR(found.area(BorderRole::kInner) / inner, 1.0, 0.03) << what;
    EXPECT_GT(found.area(BorderRole::kRight), septum) << what;
    EXPECT_GT(found.measures.monotone, 0.97) << what;
  }
}

}  // namespace
}  // namespace palpate
