/// The edges of a box as lines.
#pragma once

#include <vector>

#include "common/math/vec.h"

namespace palpate {

/// Its twelve edges, of two points each; none of an empty box.
[[nodiscard]] inline std::vector<std::vector<Vec3>> box_edges(const Box& box) {
  if (box.empty()) return {};
  const Vec3 a = box.lower, b = box.upper;
  std::vector<std::vector<Vec3>> edges;
  for (const double z : {a.z, b.z}) {
    edges.push_back({{a.x, a.y, z}, {b.x, a.y, z}});
    edges.push_back({{b.x, a.y, z}, {b.x, b.y, z}});
    edges.push_back({{b.x, b.y, z}, {a.x, b.y, z}});
    edges.push_back({{a.x, b.y, z}, {a.x, a.y, z}});
  }
  for (const double x : {a.x, b.x}) {
    for (const double y : {a.y, b.y}) edges.push_back({{x, y, a.z}, {x, y, b.z}});
  }
  return edges;
}

}  // namespace palpate
