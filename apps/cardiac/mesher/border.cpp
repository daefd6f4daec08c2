#include "apps/cardiac/mesher/border.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {
namespace {

/// Twice a triangle's area over its longest edge squared below which it has none.
constexpr double kNoArea = 1e-10;

Vec3 area_vector(const WallBorder& border, const std::array<std::uint32_t, 3>& t) {
  const Vec3& a = border.points[t[0]];
  return glm::cross(border.points[t[1]] - a, border.points[t[2]] - a);
}

double solid_angle(const WallBorder& border, const std::array<std::uint32_t, 3>& t, const Vec3& x) {
  const Vec3 a = border.points[t[0]] - x, b = border.points[t[1]] - x, c = border.points[t[2]] - x;
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  return 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)),
                          la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
}

/// The surface that each triangle belongs to, by shared points.
std::vector<std::uint32_t> surface_of(const WallBorder& border) {
  std::vector<std::uint32_t> parent(border.points.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto find = [&parent](std::uint32_t p) {
    while (parent[p] != p) p = parent[p] = parent[parent[p]];
    return p;
  };
  for (const auto& t : border.triangles) {
    parent[find(t[1])] = find(t[0]);
    parent[find(t[2])] = find(t[0]);
  }
  std::vector<std::uint32_t> of;
  of.reserve(border.triangles.size());
  for (const auto& t : border.triangles) of.push_back(find(t[0]));
  return of;
}

/// A point beside a triangle of that surface, outside the wall.
Vec3 beside(const WallBorder& border, const std::vector<std::uint32_t>& surface, std::uint32_t name) {
  std::size_t largest = border.triangles.size();
  double area = -1.0;
  for (std::size_t t = 0; t < border.triangles.size(); ++t) {
    const double here = surface[t] == name ? glm::length(area_vector(border, border.triangles[t])) : -1.0;
    if (here <= area) continue;
    area = here;
    largest = t;
  }
  const auto& t = border.triangles[largest];
  const Vec3 centre = (border.points[t[0]] + border.points[t[1]] + border.points[t[2]]) / 3.0;
  const Vec3 outward = glm::normalize(area_vector(border, t));
  constexpr int kHalvings = 27;  // down to a billionth of the triangle's size
  double step = 0.1 * std::sqrt(area);
  for (int i = 0; i < kHalvings; ++i, step *= 0.5) {
    const Vec3 x = centre + step * outward;
    if (std::abs(winding_number(border, x)) < 0.5) return x;
  }
  throw work_error("no point was found in a cavity of the wall: its surfaces touch");
}

}  // namespace

double winding_number(const WallBorder& border, const Vec3& x) {
  double angle = 0.0;
  for (const auto& t : border.triangles) angle += solid_angle(border, t, x);
  return angle / (4.0 * std::numbers::pi);
}

WallBorder border_of(const SampledWall& wall) {
  const TetMesh mesh(wall.points, wall.tets, 1);
  WallBorder border;
  std::vector<std::int64_t> number(wall.points.size(), -1);
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    for (std::size_t f = 0; f < 4; ++f) {
      if (mesh.neighbors()[c][f] != kNoCell || mesh.zero_volume(static_cast<CellIndex>(c))) continue;
      std::array<std::uint32_t, 3> triangle{};
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t p = mesh.cells()[c][kTetFaces[f][i]];
        if (number[p] < 0) {
          number[p] = static_cast<std::int64_t>(border.points.size());
          border.points.push_back(wall.points[p]);
        }
        triangle[i] = static_cast<std::uint32_t>(number[p]);
      }
      border.triangles.push_back(triangle);
    }
  }

  // A surface that encloses a volume below zero has the wall outside it.
  const std::vector<std::uint32_t> surface = surface_of(border);
  std::map<std::uint32_t, double> enclosed;
  for (std::size_t t = 0; t < border.triangles.size(); ++t) {
    const auto& [a, b, c] = border.triangles[t];
    const Vec3 origin = border.points.front();
    enclosed[surface[t]] +=
        glm::dot(border.points[a] - origin, glm::cross(border.points[b] - origin, border.points[c] - origin));
  }
  for (const auto& [name, volume] : enclosed)
    if (volume < 0.0) border.holes.push_back(beside(border, surface, name));
  return border;
}

void check_border(const WallBorder& border) {
  if (border.triangles.size() < 4)
    throw work_error("a border of " + counted(border.triangles.size(), "triangle") + " encloses nothing");
  std::vector<std::array<std::uint32_t, 3>> sorted;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : border.triangles) {
    double longest = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      longest = std::max(longest, glm::distance(border.points[a], border.points[b]));
      ++edges[{std::min(a, b), std::max(a, b)}];
    }
    if (!(glm::length(area_vector(border, t)) > kNoArea * longest * longest))
      throw work_error("a triangle of the border has no area (points " + std::to_string(t[0]) + ", " +
                       std::to_string(t[1]) + ", " + std::to_string(t[2]) + ")");
    sorted.push_back(t);
    std::sort(sorted.back().begin(), sorted.back().end());
  }
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
    throw work_error("a triangle of the border stands there twice");
  for (const auto& [edge, count] : edges)
    if (count % 2 != 0) throw work_error("the border is open at an edge: it encloses nothing");
  std::vector<Vec3> places = border.points;
  const auto before = [](const Vec3& a, const Vec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  };
  std::sort(places.begin(), places.end(), before);
  if (std::adjacent_find(places.begin(), places.end()) != places.end())
    throw work_error("two points of the border lie at one place");
}

}  // namespace palpate
