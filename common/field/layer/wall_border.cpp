#include "common/field/layer/wall_border.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "common/base/disjoint_sets.h"
#include "common/base/index.h"

namespace palpate {
namespace {

struct Edge {
  std::uint32_t low, high, triangle;
};

std::vector<Edge> edges_of(const WallBorder& border) {
  std::vector<Edge> edges;
  edges.reserve(3 * border.triangles.size());
  for (std::size_t t = 0; t < border.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = border.triangles[t][i], b = border.triangles[t][(i + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(t)});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    if (a.low != b.low) return a.low < b.low;
    return a.high != b.high ? a.high < b.high : a.triangle < b.triangle;
  });
  return edges;
}

/// BorderPart::bulge, as the volume of the pyramids over all triangles with their tip in the rim's middle.
void set_bulges(const TetMesh& mesh, const WallBorder& border, const std::vector<std::uint32_t>& part_of,
                std::vector<BorderPart>& parts) {
  const std::span<const Vec3> points = mesh.points();
  std::vector<Vec3> middle(parts.size(), Vec3{0.0});
  std::vector<double> length(parts.size(), 0.0);
  for (const auto& [a, b] : border.joints) {
    if (part_of[a] == part_of[b]) continue;
    for (const std::uint32_t corner : border.triangles[a]) {
      const auto& other = border.triangles[b];
      if (std::find(other.begin(), other.end(), corner) == other.end()) continue;
      for (const std::uint32_t part : {part_of[a], part_of[b]}) {
        middle[part] += points[corner];
        length[part] += 1.0;
      }
    }
  }
  for (std::size_t p = 0; p < parts.size(); ++p) {
    BorderPart& part = parts[p];
    const Vec3 tip = length[p] > 0.0 ? middle[p] / length[p] : part.bounds.center();
    double volume = 0.0;
    for (const std::uint32_t t : part.triangles)
      volume += glm::dot(triangle_middle(points, border.triangles[t]) - tip, border.areas[t]) / 3.0;
    if (part.area > 0.0) part.bulge = volume / (part.area * std::sqrt(part.area));
  }
}

}  // namespace

Vec3 WallBorder::normal(std::size_t triangle) const {
  const double length = glm::length(areas[triangle]);
  return length > 0.0 ? areas[triangle] / length : Vec3{0.0};
}

WallBorder border_of(const TetMesh& mesh) {
  WallBorder border;
  const std::span<const Vec3> points = mesh.points();
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    const TetMesh::Tet& tet = mesh.cells()[c];
    for (std::size_t f = 0; f < 4; ++f) {
      if (mesh.neighbors()[c][f] != kNoCell) continue;
      const std::array<std::uint32_t, 3> t{tet[kTetFaces[f][0]], tet[kTetFaces[f][1]], tet[kTetFaces[f][2]]};
      border.triangles.push_back(t);
      border.areas.push_back(0.5 * glm::cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]));
      border.cells.push_back(static_cast<CellIndex>(c));
      border.faces.push_back(static_cast<std::uint8_t>(f));
    }
  }
  const std::vector<Edge> edges = edges_of(border);
  for (std::size_t e = 1; e < edges.size(); ++e)
    if (edges[e - 1].low == edges[e].low && edges[e - 1].high == edges[e].high)
      border.joints.emplace_back(edges[e - 1].triangle, edges[e].triangle);
  return border;
}

std::vector<BorderPart> border_parts(const TetMesh& mesh, const WallBorder& border, double crease) {
  const double least_cosine = std::cos(crease);
  return border_parts(mesh, border, [&](std::size_t a, std::size_t b) {
    // A triangle without area has no normal and goes with its neighbours.
    const Vec3 m = border.normal(a), n = border.normal(b);
    return m == Vec3{0.0} || n == Vec3{0.0} || glm::dot(m, n) > least_cosine;
  });
}

std::vector<BorderPart> border_parts(const TetMesh& mesh, const WallBorder& border,
                                     const std::function<bool(std::size_t, std::size_t)>& one) {
  const std::span<const Vec3> points = mesh.points();
  DisjointSets groups(border.triangles.size());
  for (const auto& [a, b] : border.joints)
    if (one(a, b)) groups.unite(a, b);
  std::vector<BorderPart> parts;
  std::vector<std::int64_t> part_of_root(border.triangles.size(), -1);
  for (std::size_t t = 0; t < border.triangles.size(); ++t) {
    const std::uint32_t root = groups.find(static_cast<std::uint32_t>(t));
    if (part_of_root[root] < 0) {
      part_of_root[root] = static_cast<std::int64_t>(parts.size());
      parts.emplace_back();
    }
    BorderPart& part = parts[as_size(part_of_root[root])];
    part.triangles.push_back(static_cast<std::uint32_t>(t));
    part.area += glm::length(border.areas[t]);
    part.normal += border.areas[t];
    for (const std::uint32_t p : border.triangles[t]) part.bounds.include(points[p]);
  }
  for (BorderPart& part : parts)
    if (part.area > 0.0) part.normal /= part.area;
  std::stable_sort(parts.begin(), parts.end(),
                   [](const BorderPart& a, const BorderPart& b) { return a.area > b.area; });
  std::vector<std::uint32_t> part_of(border.triangles.size());
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (const std::uint32_t t : parts[p].triangles) part_of[t] = static_cast<std::uint32_t>(p);
  set_bulges(mesh, border, part_of, parts);
  return parts;
}

WallCrossing::WallCrossing(const TetMesh& mesh, const WallBorder& border)
    : mesh_(mesh),
      border_(border),
      triangle_of_(4 * mesh.cells().size(), static_cast<std::uint32_t>(border.triangles.size())) {
  for (std::size_t t = 0; t < border.triangles.size(); ++t)
    triangle_of_[4 * as_size(border.cells[t]) + border.faces[t]] = static_cast<std::uint32_t>(t);
}

std::size_t WallCrossing::from(std::size_t triangle) const {
  const std::span<const Vec3> points = mesh_.points();
  const Vec3 way = -border_.normal(triangle);
  const Vec3 start = triangle_middle(points, border_.triangles[triangle]);
  const std::size_t lost = border_.triangles.size();
  if (way == Vec3{0.0}) return lost;
  CellIndex cell = border_.cells[triangle];
  std::size_t entered = border_.faces[triangle];
  // As long as the way goes through ever other cells; a walk that turns in circles by rounding ends.
  for (std::size_t step = 0; step < mesh_.cells().size(); ++step) {
    const TetMesh::Tet& tet = mesh_.cells()[as_size(cell)];
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t leaves = 4;
    for (std::size_t f = 0; f < 4; ++f) {
      if (f == entered) continue;
      const Vec3 &a = points[tet[kTetFaces[f][0]]], &b = points[tet[kTetFaces[f][1]]],
                 &c = points[tet[kTetFaces[f][2]]];
      const Vec3 outward = glm::cross(b - a, c - a);
      const double along = glm::dot(outward, way);
      if (!(along > 0.0)) continue;
      const double at = glm::dot(outward, a - start) / along;
      if (at < nearest) {
        nearest = at;
        leaves = f;
      }
    }
    if (leaves == 4) return lost;
    const CellIndex behind = mesh_.neighbors()[as_size(cell)][leaves];
    if (behind == kNoCell) return triangle_of_[4 * as_size(cell) + leaves];
    const auto& back = mesh_.neighbors()[as_size(behind)];
    entered = as_size(std::find(back.begin(), back.end(), cell) - back.begin());
    cell = behind;
  }
  return lost;
}

}  // namespace palpate
