#include "common/field/grid/cell_faces.h"

#include <algorithm>
#include <tuple>

#include "common/base/index.h"

namespace palpate {
namespace {

struct TypeInfo {
  std::uint8_t type;
  std::uint8_t linear;  ///< the cell at its corners
  std::uint8_t points;  ///< 0: any number from the corners on
  std::uint8_t corners;
};

constexpr std::array<TypeInfo, 29> kVolumes{{
    {kTetrahedron, kTetrahedron, 4, 4},
    {kVoxel, kVoxel, 8, 8},
    {kHexahedron, kHexahedron, 8, 8},
    {kWedge, kWedge, 6, 6},
    {kPyramid, kPyramid, 5, 5},
    {kPentagonalPrism, kPentagonalPrism, 10, 10},
    {kHexagonalPrism, kHexagonalPrism, 12, 12},
    {kQuadraticTetrahedron, kTetrahedron, 10, 4},
    {25, kHexahedron, 20, 8},                       // quadratic hexahedron
    {26, kWedge, 15, 6},                            // quadratic wedge
    {27, kPyramid, 13, 5},                          // quadratic pyramid
    {kTriquadraticHexahedron, kHexahedron, 27, 8},  //
    {31, kWedge, 12, 6},                            // quadratic-linear wedge
    {32, kWedge, 18, 6},                            // biquadratic-quadratic wedge
    {33, kHexahedron, 24, 8},                       // biquadratic-quadratic hexahedron
    {37, kPyramid, 19, 5},                          // triquadratic pyramid
    {kPolyhedron, kPolyhedron, 0, 0},
    {64, kTetrahedron, 0, 4},  // higher order
    {65, kWedge, 0, 6},
    {66, kPyramid, 0, 5},
    {67, kHexahedron, 0, 8},
    {71, kTetrahedron, 0, 4},  // Lagrange
    {72, kHexahedron, 0, 8},
    {73, kWedge, 0, 6},
    {74, kPyramid, 0, 5},
    {78, kTetrahedron, 0, 4},  // Bezier
    {79, kHexahedron, 0, 8},
    {80, kWedge, 0, 6},
    {81, kPyramid, 0, 5},
}};

/// Empty, point, line and surface types of any order.
constexpr std::array<std::uint8_t, 26> kFlat{0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  21, 22, 23,
                                             28, 30, 34, 35, 36, 60, 61, 62, 63, 68, 69, 70, 75};

const TypeInfo* info_of(std::uint8_t type) noexcept {
  const auto found = std::ranges::find(kVolumes, type, &TypeInfo::type);
  return found == kVolumes.end() ? nullptr : &*found;
}

/// A prism over a polygon of n vertices: base, top, sides.
CellFaces prism(std::uint8_t n) {
  CellFaces out;
  std::vector<std::uint8_t> base;
  std::vector<std::uint8_t> top;
  for (std::uint8_t i = 0; i < n; ++i) {
    base.push_back(static_cast<std::uint8_t>(n - 1 - i));
    top.push_back(static_cast<std::uint8_t>(n + i));
  }
  out.faces = {base, top};
  for (std::uint8_t i = 0; i < n; ++i) {
    const auto j = static_cast<std::uint8_t>((i + 1) % n);
    out.faces.push_back({i, j, static_cast<std::uint8_t>(n + j), static_cast<std::uint8_t>(n + i)});
  }
  return out;
}

CellFaces hexahedron() {
  CellFaces out;
  for (const auto& face : kHexahedronFaces) out.faces.emplace_back(face.begin(), face.end());
  return out;
}

}  // namespace

bool is_volume(std::uint8_t type) noexcept { return info_of(type) != nullptr; }

bool is_flat(std::uint8_t type) noexcept {
  return type == 76 || type == 77 || std::ranges::find(kFlat, type) != kFlat.end();
}

bool is_surface(std::uint8_t type) noexcept {
  constexpr std::array<std::uint8_t, 10> kPointsAndLines{0, 1, 2, 3, 4, 21, 35, 60, 68, 75};
  return is_flat(type) && std::ranges::find(kPointsAndLines, type) == kPointsAndLines.end();
}

std::size_t point_count_of(std::uint8_t type) noexcept {
  const TypeInfo* info = info_of(type);
  return info == nullptr ? 0 : info->points;
}

std::uint8_t linear_type_of(std::uint8_t type) noexcept {
  const TypeInfo* info = info_of(type);
  return info == nullptr ? type : info->linear;
}

std::size_t corner_count_of(std::uint8_t type) noexcept {
  const TypeInfo* info = info_of(type);
  return info == nullptr ? 0 : info->corners;
}

const CellFaces* faces_of(std::uint8_t type) noexcept {
  static const CellFaces kTetrahedronFaces{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  static const CellFaces kPyramidFaces{{{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
  static const CellFaces kHexahedronList = hexahedron();
  static const CellFaces kWedgeFaces = prism(3);
  static const CellFaces kPentagonalFaces = prism(5);
  static const CellFaces kHexagonalFaces = prism(6);
  switch (type) {
    case kTetrahedron:
      return &kTetrahedronFaces;
    case kHexahedron:
      return &kHexahedronList;
    case kWedge:
      return &kWedgeFaces;
    case kPyramid:
      return &kPyramidFaces;
    case kPentagonalPrism:
      return &kPentagonalFaces;
    case kHexagonalPrism:
      return &kHexagonalFaces;
    default:
      return nullptr;
  }
}

void orient_faces(FaceList& faces) {
  struct Edge {
    std::uint32_t low;
    std::uint32_t high;
    std::size_t face;
    bool rising;  ///< passed from low to high
  };
  const std::size_t count = faces.ends.size();
  std::vector<Edge> edges;
  edges.reserve(faces.ids.size());
  std::size_t begin = 0;
  for (std::size_t f = 0; f < count; begin = faces.ends[f++]) {
    for (std::size_t i = begin; i < faces.ends[f]; ++i) {
      const std::uint32_t a = faces.ids[i];
      const std::uint32_t b = faces.ids[i + 1 < faces.ends[f] ? i + 1 : begin];
      if (a != b) edges.push_back({std::min(a, b), std::max(a, b), f, a < b});
    }
  }
  std::ranges::sort(edges, [](const Edge& a, const Edge& b) {
    return std::tuple(a.low, a.high, a.face) < std::tuple(b.low, b.high, b.face);
  });

  // An edge that exactly two faces share says whether they agree.
  struct Link {
    std::size_t to;
    bool agree;
  };
  std::vector<std::vector<Link>> links(count);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
    if (end - i == 2) {
      const bool agree = edges[i].rising != edges[i + 1].rising;
      links[edges[i].face].push_back({edges[i + 1].face, agree});
      links[edges[i + 1].face].push_back({edges[i].face, agree});
    }
    i = end;
  }

  std::vector<std::uint8_t> seen(count, 0);
  std::vector<std::uint8_t> turned(count, 0);
  std::vector<std::size_t> pending;
  for (std::size_t start = 0; start < count; ++start) {
    if (seen[start] != 0) continue;
    seen[start] = 1;
    pending.push_back(start);
    while (!pending.empty()) {
      const std::size_t face = pending.back();
      pending.pop_back();
      for (const Link& link : links[face]) {
        if (seen[link.to] != 0) continue;
        seen[link.to] = 1;
        turned[link.to] = link.agree ? turned[face] : static_cast<std::uint8_t>(1 - turned[face]);
        pending.push_back(link.to);
      }
    }
  }
  begin = 0;
  for (std::size_t f = 0; f < count; begin = faces.ends[f++]) {
    if (turned[f] == 0) continue;
    std::reverse(faces.ids.begin() + static_cast<std::ptrdiff_t>(begin),
                 faces.ids.begin() + static_cast<std::ptrdiff_t>(faces.ends[f]));
  }
}

void for_each_polyhedron_edge(const UnstructuredTopology& cells,
                              const std::function<void(std::size_t, std::size_t)>& visit) {
  const std::size_t points = cells.positions.tuples;
  const auto known = [&](std::int64_t id) { return id >= 0 && as_size(id) < points; };
  for (std::size_t c = 0; c < cells.types.size(); ++c) {
    if (cells.types[c] != kPolyhedron) continue;
    const auto end = as_size(cells.offsets[c + 1]);
    std::size_t at = as_size(cells.offsets[c]) + 1;
    while (at < end) {
      const std::int64_t count = cells.connectivity[at++];
      if (count < 0 || as_size(count) > end - at) break;
      const std::size_t first = at;
      at += as_size(count);
      for (std::size_t i = first; i < at; ++i) {
        const std::int64_t p = cells.connectivity[i];
        const std::int64_t q = cells.connectivity[i + 1 < at ? i + 1 : first];
        if (known(p) && known(q)) visit(as_size(p), as_size(q));
      }
    }
  }
}

}  // namespace palpate
