#include "common/field/layer/part_rims.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>

#include "common/base/disjoint_sets.h"

namespace palpate {
namespace {

/// An edge of one part, as that part sees it.
struct RimEdge {
  std::array<std::uint32_t, 2> ends{};
  std::size_t beyond = 0;  ///< the other part
};

std::vector<PartRim> rims_of(std::span<const Vec3> points, const std::vector<RimEdge>& edges) {
  std::map<std::uint32_t, std::uint32_t> number;  // of the points on the rims
  for (const RimEdge& edge : edges)
    for (const std::uint32_t p : edge.ends) number.emplace(p, static_cast<std::uint32_t>(number.size()));
  DisjointSets rims(number.size());
  for (const RimEdge& edge : edges) rims.unite(number.at(edge.ends[0]), number.at(edge.ends[1]));
  std::map<std::uint32_t, std::map<std::size_t, double>> lengths;  // by root and part
  for (const RimEdge& edge : edges)
    lengths[rims.find(number.at(edge.ends[0]))][edge.beyond] +=
        glm::length(points[edge.ends[1]] - points[edge.ends[0]]);
  std::vector<PartRim> found;
  for (const auto& [root, beside] : lengths) {
    PartRim rim;
    for (const auto& [part, length] : beside) {
      rim.beside.push_back({part, length});
      rim.length += length;
    }
    found.push_back(std::move(rim));
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const PartRim& a, const PartRim& b) { return a.length > b.length; });
  return found;
}

}  // namespace

std::vector<std::vector<PartRim>> part_rims(const TetMesh& mesh, const WallBorder& border,
                                            std::span<const std::size_t> part_of, std::size_t parts) {
  std::vector<std::vector<RimEdge>> edges(parts);
  for (const auto& [a, b] : border.joints) {
    if (part_of[a] == part_of[b]) continue;
    RimEdge edge;
    std::size_t shared = 0;
    for (const std::uint32_t corner : border.triangles[a]) {
      const auto& other = border.triangles[b];
      if (shared < 2 && std::find(other.begin(), other.end(), corner) != other.end())
        edge.ends.at(shared++) = corner;
    }
    if (shared < 2) continue;
    edge.beyond = part_of[b];
    edges[part_of[a]].push_back(edge);
    edge.beyond = part_of[a];
    edges[part_of[b]].push_back(edge);
  }
  std::vector<std::vector<PartRim>> rims;
  rims.reserve(parts);
  for (const auto& of_part : edges) rims.push_back(rims_of(mesh.points(), of_part));
  return rims;
}

}  // namespace palpate
