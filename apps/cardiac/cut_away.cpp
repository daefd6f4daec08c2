#include "apps/cardiac/cut_away.h"

#include <array>
#include <cmath>
#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/math/vec.h"

namespace palpate {

std::optional<CutPlane> parse_cut(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto v = parse_numbers(text, 4, "--cut takes nx,ny,nz,d for the plane n.x = d");
  CutPlane plane{{v[0], v[1], v[2]}, v[3]};
  const double length = normal_length(plane.normal);
  if (!(length > 0.0)) throw usage_error("--cut " + text + ": the normal is zero");
  plane.normal /= length;
  plane.distance /= length;
  return plane;
}

void cut_surface(const CutPlane& plane, IsosurfaceMesh& mesh, std::vector<float>* values) {
  std::vector<std::array<std::uint32_t, 3>> kept;
  for (const auto& triangle : mesh.triangles) {
    // The polygon that is left, corner by corner; crossings become points of their own.
    std::array<std::uint32_t, 4> polygon{};
    std::size_t corners = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = triangle[i], b = triangle[(i + 1) % 3];
      const double at_a = plane.beyond(mesh.points[a]), at_b = plane.beyond(mesh.points[b]);
      if (at_a <= 0.0) polygon[corners++] = a;
      if ((at_a <= 0.0) == (at_b <= 0.0)) continue;
      const double part = at_a / (at_a - at_b);
      const Vec3f normal = mesh.normals[a] + static_cast<float>(part) * (mesh.normals[b] - mesh.normals[a]);
      polygon[corners++] = static_cast<std::uint32_t>(mesh.points.size());
      mesh.points.push_back(glm::mix(mesh.points[a], mesh.points[b], part));
      mesh.normals.push_back(normal);
      if (values != nullptr)
        values->push_back(std::lerp((*values)[a], (*values)[b], static_cast<float>(part)));
    }
    for (std::size_t i = 2; i < corners; ++i) kept.push_back({polygon[0], polygon[i - 1], polygon[i]});
  }
  mesh.triangles = std::move(kept);
}

void cut_lines(const CutPlane& plane, std::vector<Line>& lines) {
  std::vector<Line> kept;
  for (const Line& line : lines) {
    Line piece = line;
    piece.points.clear();
    for (const LinePoint& point : line.points) {
      if (plane.beyond(point.position) <= 0.0) {
        piece.points.push_back(point);
        continue;
      }
      if (piece.points.size() > 1) kept.push_back(piece);
      piece.points.clear();
    }
    if (piece.points.size() > 1) kept.push_back(std::move(piece));
  }
  lines = std::move(kept);
}

}  // namespace palpate
