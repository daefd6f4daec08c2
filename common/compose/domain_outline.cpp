#include "common/compose/domain_outline.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "common/field/grid/box_grid.h"
#include "common/field/grid/tet_mesh.h"

namespace palpate {
namespace {

constexpr double kSharpCosine = 0.64;      // of 50 degrees between the normals of two border faces
constexpr std::size_t kMostEdges = 20000;  // a border as rough as a sponge has no outline

/// An edge of a border face with the face's unit normal.
struct BorderEdge {
  std::pair<std::uint32_t, std::uint32_t> points;
  Vec3 normal{0.0};
};

std::vector<BorderEdge> border_edges(const TetMesh& mesh) {
  std::vector<BorderEdge> edges;
  const auto x = mesh.points();
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    for (std::size_t face = 0; face < 4; ++face) {
      if (mesh.neighbors()[c][face] != kNoCell) continue;
      std::array<std::uint32_t, 3> v{};
      std::size_t count = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        if (i != face) v[count++] = mesh.cells()[c][i];
      }
      Vec3 normal = glm::cross(x[v[1]] - x[v[0]], x[v[2]] - x[v[0]]);
      const double length = glm::length(normal);
      if (!(length > 0.0)) continue;
      normal /= length;
      // Outward: away from the vertex that is not on the face.
      if (glm::dot(normal, x[mesh.cells()[c][face]] - x[v[0]]) > 0.0) normal = -normal;
      for (std::size_t i = 0; i < 3; ++i) edges.push_back({std::minmax(v[i], v[(i + 1) % 3]), normal});
    }
  }
  return edges;
}

std::vector<std::vector<Vec3>> tet_outline(const TetMesh& mesh, const LocalFrame& frame) {
  std::vector<BorderEdge> edges = border_edges(mesh);
  std::stable_sort(edges.begin(), edges.end(),
                   [](const BorderEdge& a, const BorderEdge& b) { return a.points < b.points; });
  std::vector<std::vector<Vec3>> outline;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const BorderEdge& a = edges[i];
    const BorderEdge& b = edges[i + 1];
    if (a.points != b.points || glm::dot(a.normal, b.normal) > kSharpCosine) continue;
    outline.push_back({frame.data_from_local(mesh.points()[a.points.first]),
                       frame.data_from_local(mesh.points()[a.points.second])});
    if (outline.size() > kMostEdges) return {};
  }
  return outline;
}

std::vector<std::vector<Vec3>> box_outline(const BoxGrid& grid, const LocalFrame& frame) {
  const Box box = grid.bounds();
  std::vector<std::vector<Vec3>> outline;
  const auto corner = [&](int bits) {
    const Vec3 part{bits & 1, bits >> 1 & 1, bits >> 2 & 1};
    return frame.data_from_local(grid.in_frame(box.lower + part * box.size()));
  };
  for (int from = 0; from < 8; ++from) {
    for (const int axis : {1, 2, 4}) {
      if ((from & axis) == 0) outline.push_back({corner(from), corner(from | axis)});
    }
  }
  return outline;
}

}  // namespace

std::vector<std::vector<Vec3>> image_outline(const Vec3& origin, const Mat3& axes, const Vec3& lower,
                                             const Vec3& upper) {
  const auto corner = [&](unsigned c) {
    const Vec3 g{(c & 1U) != 0 ? upper.x : lower.x, (c & 2U) != 0 ? upper.y : lower.y,
                 (c & 4U) != 0 ? upper.z : lower.z};
    return origin + axes * g;
  };
  std::vector<std::vector<Vec3>> edges;
  for (unsigned c = 0; c < 8; ++c) {
    for (const unsigned along : {1U, 2U, 4U}) {
      if ((c & along) == 0) edges.push_back({corner(c), corner(c | along)});
    }
  }
  return edges;
}

std::vector<std::vector<Vec3>> domain_outline(const VectorField& field) {
  if (const TetMesh* mesh = field.tet_mesh()) return tet_outline(*mesh, field.frame());
  if (field.box_grid() && field.frame().rotated) return box_outline(*field.box_grid(), field.frame());
  return {};
}

}  // namespace palpate
