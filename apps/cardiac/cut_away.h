/// Leaving out what lies beyond a plane, so that the inside of a heart can be seen.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/geometry/line.h"
#include "common/math/vec.h"
#include "common/trace/isosurface/isosurface_mesh.h"

namespace palpate {

/// Keeps what has n . x <= d.
struct CutPlane {
  Vec3 normal{0.0};
  double distance = 0.0;

  [[nodiscard]] double beyond(const Vec3& x) const noexcept { return glm::dot(normal, x) - distance; }
};

/// "nx,ny,nz,d"; nothing for an empty text. @throws Error (usage).
[[nodiscard]] std::optional<CutPlane> parse_cut(const std::string& text);

/// Triangles that cross the plane are cut along it.
/// @param values a number a point, which new points get by linear interpolation; null: none.
void cut_surface(const CutPlane& plane, IsosurfaceMesh& mesh, std::vector<float>* values = nullptr);

/// Lines that cross it end, and begin, at their last point this side of it.
void cut_lines(const CutPlane& plane, std::vector<Line>& lines);

}  // namespace palpate
