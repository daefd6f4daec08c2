#include "common/field/layer/wall_surfaces.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <span>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// The corners opposite each vertex of a positively oriented tetrahedron, their normal outwards.
constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

std::vector<Triangle> border_of(const TetMesh& mesh) {
  std::vector<Triangle> border;
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    const TetMesh::Tet& tet = mesh.cells()[c];
    for (std::size_t f = 0; f < 4; ++f) {
      if (mesh.neighbors()[c][f] != kNoCell) continue;
      border.push_back({tet[kFaces[f][0]], tet[kFaces[f][1]], tet[kFaces[f][2]]});
    }
  }
  return border;
}

/// Twice the area, outwards.
Vec3 area_vector(std::span<const Vec3> points, const Triangle& t) {
  return glm::cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
}

/// Sets that are merged two by two.
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t find(std::uint32_t item) {
    while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
    return item;
  }
  void merge(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

struct Edge {
  std::uint32_t low, high, triangle;
};

constexpr double kCrease = 40.0 * std::numbers::pi / 180.0;
constexpr double kSmallPart = 0.01;  // of the border's area
constexpr double kFlat = 0.99;       // of a part's area, that its normals add up to

bool both(const std::vector<WallSurface>& of_point) {
  const auto has = [&](WallSurface surface) {
    return std::find(of_point.begin(), of_point.end(), surface) != of_point.end();
  };
  return has(WallSurface::kInner) && has(WallSurface::kOuter);
}

std::vector<WallSurface> tagged(const FieldGrid& grid, const DataArray& array) {
  std::vector<WallSurface> of_point(grid.point_count(), WallSurface::kNone);
  for (std::size_t p = 0; p < array.tuples; ++p) {
    const double tag = array.at(p);
    const std::size_t point = grid.point_of_input.empty() ? p : grid.point_of_input[p];
    if (point >= of_point.size()) continue;  // no cell uses it
    if (tag == 1.0) of_point[point] = WallSurface::kInner;
    if (tag == 2.0) of_point[point] = WallSurface::kOuter;
  }
  return of_point;
}

}  // namespace

std::vector<BoundaryPatch> boundary_patches(const TetMesh& mesh, double crease) {
  const std::vector<Triangle> border = border_of(mesh);
  const std::span<const Vec3> points = mesh.points();
  std::vector<Vec3> normals;
  normals.reserve(border.size());
  for (const Triangle& t : border) {
    const Vec3 area = area_vector(points, t);
    const double length = glm::length(area);
    normals.push_back(length > 0.0 ? area / length : Vec3{0.0});
  }

  std::vector<Edge> edges;
  edges.reserve(3 * border.size());
  for (std::size_t t = 0; t < border.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = border[t][i], b = border[t][(i + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(t)});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    if (a.low != b.low) return a.low < b.low;
    return a.high != b.high ? a.high < b.high : a.triangle < b.triangle;
  });
  Groups groups(border.size());
  const double least_cosine = std::cos(crease);
  for (std::size_t e = 1; e < edges.size(); ++e) {
    const Edge &a = edges[e - 1], &b = edges[e];
    if (a.low != b.low || a.high != b.high) continue;
    // A triangle without area has no normal and goes with its neighbours.
    const Vec3 &m = normals[a.triangle], &n = normals[b.triangle];
    const bool flat = m == Vec3{0.0} || n == Vec3{0.0};
    if (flat || glm::dot(m, n) > least_cosine) groups.merge(a.triangle, b.triangle);
  }

  std::vector<BoundaryPatch> patches;
  std::vector<std::int64_t> patch_of(border.size(), -1);
  for (std::size_t t = 0; t < border.size(); ++t) {
    const std::uint32_t root = groups.find(static_cast<std::uint32_t>(t));
    if (patch_of[root] < 0) {
      patch_of[root] = static_cast<std::int64_t>(patches.size());
      patches.emplace_back();
    }
    BoundaryPatch& patch = patches[as_size(patch_of[root])];
    const Vec3 area = 0.5 * area_vector(points, border[t]);
    patch.triangles.push_back(border[t]);
    patch.area += glm::length(area);
    patch.normal += area;
    for (const std::uint32_t p : border[t]) patch.bounds.include(points[p]);
  }
  for (BoundaryPatch& patch : patches)
    if (patch.area > 0.0) patch.normal /= patch.area;
  std::stable_sort(patches.begin(), patches.end(),
                   [](const BoundaryPatch& a, const BoundaryPatch& b) { return a.area > b.area; });
  return patches;
}

WallSurfaces find_wall_surfaces(const FieldGrid& grid, const DataSet& mesh, const std::string& file) {
  const auto refuse = [&file](const std::string& found) {
    throw input_error({file, "", found, "an inner and an outer surface",
                       std::string("name them in a point array '") + kSurfaceArray + "': 1 inner, 2 outer"});
  };
  if (!grid.tets) refuse("is an image, whose border has no inner surface");
  WallSurfaces surfaces;
  if (const DataArray* array = mesh.find(kSurfaceArray, Association::kPoint)) {
    surfaces.of_point = tagged(grid, *array);
    surfaces.note = std::string("inner and outer surface from the array '") + kSurfaceArray + "'";
    if (!both(surfaces.of_point)) refuse(std::string("has not both in its array '") + kSurfaceArray + "'");
    return surfaces;
  }

  const std::vector<BoundaryPatch> patches = boundary_patches(*grid.tets, kCrease);
  double area = 0.0;
  for (const BoundaryPatch& patch : patches) area += patch.area;
  const BoundaryPatch* outer = nullptr;
  std::vector<const BoundaryPatch*> inner;
  std::size_t cuts = 0;
  for (const BoundaryPatch& patch : patches) {
    if (patch.area < kSmallPart * area) continue;
    if (glm::length(patch.normal) > kFlat) {
      ++cuts;
    } else if (outer == nullptr || patch.bounds.diagonal() > outer->bounds.diagonal()) {
      if (outer != nullptr) inner.push_back(outer);
      outer = &patch;
    } else {
      inner.push_back(&patch);
    }
  }
  if (outer == nullptr || inner.empty())
    refuse("has a border of " + counted(patches.size(), "smooth part") + ", none of them an inner surface");
  surfaces.of_point.assign(grid.point_count(), WallSurface::kNone);
  const auto mark = [&surfaces](const BoundaryPatch& patch, WallSurface surface) {
    for (const auto& triangle : patch.triangles)
      for (const std::uint32_t p : triangle) surfaces.of_point[p] = surface;
  };
  mark(*outer, WallSurface::kOuter);
  for (const BoundaryPatch* patch : inner) mark(*patch, WallSurface::kInner);
  surfaces.note = "found by the creases of the border: an outer surface, " +
                  counted(inner.size(), "inner surface") + ", " + counted(cuts, "flat cut");
  if (!both(surfaces.of_point)) refuse("has an inner surface that is all rim");
  return surfaces;
}

}  // namespace palpate
