#include "common/field/layer/tagged_surfaces.h"

#include <algorithm>
#include <cstddef>

namespace palpate {

std::vector<WallSurface> tagged_points(const FieldGrid& grid, const DataArray& array) {
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

std::vector<BorderRole> tagged_roles(const WallBorder& border, const std::vector<WallSurface>& of_point) {
  std::vector<BorderRole> roles(border.triangles.size(), BorderRole::kLeft);
  const auto all = [&](std::size_t t, WallSurface surface) {
    return std::all_of(border.triangles[t].begin(), border.triangles[t].end(),
                       [&](std::uint32_t p) { return of_point[p] == surface; });
  };
  Vec3 opening{0.0};
  double outer = 0.0;
  for (std::size_t t = 0; t < roles.size(); ++t) {
    if (all(t, WallSurface::kInner)) roles[t] = BorderRole::kInner;
    if (!all(t, WallSurface::kOuter)) continue;
    roles[t] = BorderRole::kOuter;
    opening -= border.areas[t];
    outer += glm::length(border.areas[t]);
  }
  constexpr double kOpens = 0.05;  // mean normal of a surface that does not go all round
  constexpr double kUp = 0.3;      // normal times axis of what does not lie along the wall
  if (!(glm::length(opening) > kOpens * outer)) return roles;
  // Where an inner surface meets an outer one, as at the rim of a septum, triangles have points of both, too.
  for (std::size_t t = 0; t < roles.size(); ++t)
    if (roles[t] == BorderRole::kLeft && glm::dot(border.normal(t), glm::normalize(opening)) > kUp)
      roles[t] = BorderRole::kBase;
  return roles;
}

}  // namespace palpate
