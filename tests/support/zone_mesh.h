/// Walls that go round an axis, as meshes of hexahedra and prisms, made by formula.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "common/field/data_set.h"
#include "common/math/vec.h"

namespace palpate::test {

/// The place of depth `s` in the wall (0 inside) and part `t` of the way along it, at an angle.
using ZonePlace = std::function<Vec3(double s, double t, double angle)>;

struct ZoneCells {
  int wall = 4, along = 12, around = 24;
};

/// Point numbers go round first, then along, then through the wall.
/// @param pole whether all angles are one place at t = 0.
inline DataSet zone_mesh(const ZonePlace& place, const ZoneCells& cells, bool pole) {
  const int rows = cells.along + (pole ? 0 : 1);
  const std::int64_t layer = static_cast<std::int64_t>(rows) * cells.around + (pole ? 1 : 0);
  const auto point = [&](int i, int j, int k) -> std::int64_t {
    if (pole && j == 0) return i * layer + layer - 1;
    return i * layer + static_cast<std::int64_t>(j - (pole ? 1 : 0)) * cells.around + k % cells.around;
  };
  const auto at = [&](int i, int j, int k) {
    return place(static_cast<double>(i) / cells.wall, static_cast<double>(j) / cells.along,
                 2.0 * std::numbers::pi * k / cells.around);
  };
  std::vector<double> x;
  const auto add = [&x](const Vec3& p) { x.insert(x.end(), {p.x, p.y, p.z}); };
  for (int i = 0; i <= cells.wall; ++i) {
    for (int j = pole ? 1 : 0; j <= cells.along; ++j)
      for (int k = 0; k < cells.around; ++k) add(at(i, j, k));
    if (pole) add(at(i, 0, 0));
  }
  constexpr std::uint8_t kHexahedron = 12, kWedge = 13;
  UnstructuredTopology topology;
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(x));
  topology.offsets.push_back(0);
  for (int i = 0; i < cells.wall; ++i) {
    for (int j = 0; j < cells.along; ++j) {
      for (int k = 0; k < cells.around; ++k) {
        const bool tip = pole && j == 0;
        for (const int side : {i, i + 1}) {
          topology.connectivity.push_back(point(side, j, k));
          topology.connectivity.push_back(point(side, j + 1, k));
          topology.connectivity.push_back(point(side, j + 1, k + 1));
          if (!tip) topology.connectivity.push_back(point(side, j, k + 1));
        }
        topology.types.push_back(tip ? kWedge : kHexahedron);
        topology.offsets.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
      }
    }
  }
  DataSet mesh;
  mesh.topology = std::move(topology);
  return mesh;
}

/// At an angle from the pole, which is below.
inline Vec3 on_sphere(double radius, double from_pole, double angle) {
  return radius * Vec3{std::sin(from_pole) * std::cos(angle), std::sin(from_pole) * std::sin(angle),
                       -std::cos(from_pole)};
}

}  // namespace palpate::test
