/// Surfaces of triangles by formula: a torus and a ball, as fine as one likes.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "common/geometry/surface_mesh.h"

namespace palpate::test {

struct Triangles {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
};

/// Rows of points around and along, joined both ways, outside in front.
/// @param place of (u, v) in [0, 1)^2.
template <typename Place>
Triangles joined_rows(std::uint32_t rows, std::uint32_t columns, const Place& place) {
  Triangles made;
  for (std::uint32_t r = 0; r < rows; ++r) {
    for (std::uint32_t c = 0; c < columns; ++c) {
      made.points.push_back(place(static_cast<double>(r) / rows, static_cast<double>(c) / columns));
      const std::uint32_t down = (r + 1) % rows, next = (c + 1) % columns;
      const std::uint32_t a = r * columns + c, b = r * columns + next;
      const std::uint32_t d = down * columns + c, e = down * columns + next;
      made.triangles.push_back({a, d, b});
      made.triangles.push_back({b, d, e});
    }
  }
  return made;
}

/// About the z axis: circle of radius `wide`, tube of radius `thin`; 2 rows columns triangles.
inline Triangles torus_triangles(double wide, double thin, std::uint32_t rows, std::uint32_t columns) {
  return joined_rows(rows, columns, [=](double u, double v) {
    const double a = 2.0 * std::numbers::pi * u, b = 2.0 * std::numbers::pi * v;
    const double out = wide + thin * std::cos(b);
    return Vec3{out * std::cos(a), out * std::sin(a), thin * std::sin(b)};
  });
}

/// A ball of eight faces, each side halved `halved` times and put on the sphere: 8 * 4^halved triangles.
inline Triangles ball_triangles(double radius, int halved) {
  Triangles made{{{1.0, 0.0, 0.0},
                  {-1.0, 0.0, 0.0},
                  {0.0, 1.0, 0.0},
                  {0.0, -1.0, 0.0},
                  {0.0, 0.0, 1.0},
                  {0.0, 0.0, -1.0}},
                 {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  for (int h = 0; h < halved; ++h) {
    std::vector<Triangle> finer;
    for (const Triangle& t : made.triangles) {
      const auto first = static_cast<std::uint32_t>(made.points.size());
      for (int s = 0; s < 3; ++s) {
        const Vec3& a = made.points[t[static_cast<std::size_t>(s)]];
        const Vec3& b = made.points[t[static_cast<std::size_t>((s + 1) % 3)]];
        // The sum is the same from either side: neighbours find the same point, which is welded.
        const Vec3 middle = glm::normalize(a + b);
        made.points.push_back(middle);
      }
      finer.push_back({t[0], first, first + 2});
      finer.push_back({first, t[1], first + 1});
      finer.push_back({first + 2, first + 1, t[2]});
      finer.push_back({first, first + 1, first + 2});
    }
    made.triangles = std::move(finer);
  }
  for (Vec3& x : made.points) x *= radius;
  return made;
}

/// The edges of a square plate in the plane z = `height`, two triangles.
inline Triangles plate_triangles(double half, double height) {
  return {{{-half, -half, height}, {half, -half, height}, {half, half, height}, {-half, half, height}},
          {{0, 1, 2}, {0, 2, 3}}};
}

}  // namespace palpate::test
