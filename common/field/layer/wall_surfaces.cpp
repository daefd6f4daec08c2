#include "common/field/layer/wall_surfaces.h"

#include <algorithm>
#include <cstddef>
#include <numbers>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/field/layer/boundary_patches.h"

namespace palpate {
namespace {

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
