#include "common/field/layer/surface_areas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {

void measure_surfaces(const FieldGrid& grid, const WallBorder& border, WallSurfaces& surfaces) {
  const double scale = grid.frame.length_scale();
  std::vector<std::vector<std::uint32_t>> beside(border.triangles.size());
  for (const auto& [a, b] : border.joints) {
    if (surfaces.roles[a] != surfaces.roles[b]) continue;
    beside[a].push_back(b);
    beside[b].push_back(a);
  }
  double total = 0.0;
  for (const Vec3& area : border.areas) total += glm::length(area);
  std::vector<bool> seen(border.triangles.size());
  for (std::size_t t = 0; t < seen.size(); ++t) {
    if (seen[t]) continue;
    std::vector<std::uint32_t> piece{static_cast<std::uint32_t>(t)};
    seen[t] = true;
    double area = 0.0;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const std::uint32_t from = piece[i];
      area += glm::length(border.areas[from]);
      for (const std::uint32_t b : beside[from]) {
        if (seen[b]) continue;
        seen[b] = true;
        piece.push_back(b);
      }
    }
    const std::size_t role = as_size(surfaces.roles[t]);
    surfaces.areas[role] += area * scale * scale;
    if (area >= kSmallPart * total) ++surfaces.pieces[role];
  }
  double left = 0.0;
  for (std::size_t t = 0; t < border.areas.size(); ++t)
    if (surfaces.roles[t] == BorderRole::kLeft) left += glm::length(border.areas[t]);
  surfaces.confidence = total > 0.0 ? 1.0 - left / total : 0.0;
}

void mark_points(const FieldGrid& grid, WallSurfaces& surfaces) {
  surfaces.of_point.assign(grid.point_count(), WallSurface::kNone);
  const auto mark = [&surfaces](BorderRole role, WallSurface surface) {
    for (std::size_t t = 0; t < surfaces.roles.size(); ++t) {
      if (surfaces.roles[t] != role) continue;
      for (const std::uint32_t p : surfaces.triangles[t]) surfaces.of_point[p] = surface;
    }
  };
  mark(BorderRole::kOuter, WallSurface::kOuter);
  mark(BorderRole::kSeptum, WallSurface::kOuter);
  mark(BorderRole::kRight, WallSurface::kInner);
  mark(BorderRole::kInner, WallSurface::kInner);
}

std::string areas_text(const WallSurfaces& surfaces) {
  std::string text;
  for (const BorderRole role :
       {BorderRole::kInner, BorderRole::kRight, BorderRole::kSeptum, BorderRole::kOuter, BorderRole::kBase}) {
    const double area = surfaces.areas[as_size(role)];
    if (!(area > 0.0)) continue;
    const std::size_t pieces = surfaces.pieces[as_size(role)];
    const bool several = surfaces.areas[as_size(BorderRole::kRight)] > 0.0 ||
                         surfaces.areas[as_size(BorderRole::kSeptum)] > 0.0;
    text += (text.empty() ? "" : ", ") +
            std::string(role == BorderRole::kInner && !several ? "endocardium" : name_of(role)) + " (area " +
            short_number(area) + (pieces > 1 ? ", " + counted(pieces, "piece") : "") + ")";
  }
  return text;
}

std::string doubt_stairs(const FieldGrid& grid, const WallBorder& border, const WallSurfaces& surfaces,
                         double step) {
  std::array<double, kBorderRoleCount> rims{};
  for (const auto& [a, b] : border.joints) {
    if (surfaces.roles[a] == surfaces.roles[b]) continue;
    std::vector<Vec3> shared;
    for (const std::uint32_t corner : border.triangles[a])
      if (std::count(border.triangles[b].begin(), border.triangles[b].end(), corner) > 0)
        shared.push_back(grid.tets->points()[corner]);
    if (shared.size() < 2) continue;
    for (const std::uint32_t t : {a, b})
      rims[as_size(surfaces.roles[t])] += glm::length(shared[1] - shared[0]);
  }
  const double scale = grid.frame.length_scale();
  std::string text = "it is made of voxels, " + short_number(step * scale) +
                     " across, whose border is stairs; rims are known to half a voxel, and areas";
  bool first = true;
  for (std::size_t r = 0; r < rims.size(); ++r) {
    if (!(surfaces.areas[r] > 0.0) || r == as_size(BorderRole::kLeft)) continue;
    text += std::string(first ? " to " : ", ") +
            short_number(std::ceil(50.0 * rims[r] * step * scale * scale / surfaces.areas[r])) + " % (" +
            name_of(static_cast<BorderRole>(r)) + ")";
    first = false;
  }
  return text;
}

}  // namespace palpate
