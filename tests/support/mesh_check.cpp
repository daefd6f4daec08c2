#include "tests/support/mesh_check.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace palpate::test {

MeshCheck check_mesh(std::span<const Vec3> points, std::span<const std::array<std::uint32_t, 4>> tets) {
  MeshCheck out;
  struct Count {
    int all = 0;
    int solid = 0;
  };
  constexpr double kFlat = 1e-13;  // of the cubes and prisms of order one that tests are made of
  std::map<std::array<std::uint32_t, 3>, Count> faces;
  for (const auto& tet : tets) {
    const Vec3 a = points[tet[1]] - points[tet[0]];
    const Vec3 b = points[tet[2]] - points[tet[0]];
    const Vec3 c = points[tet[3]] - points[tet[0]];
    const double volume = glm::dot(glm::cross(a, b), c) / 6.0;
    out.volume += std::abs(volume);
    out.signed_volume += volume;
    if (volume < -kFlat) ++out.inverted;
    for (std::size_t i = 0; i < 4; ++i) {
      std::array<std::uint32_t, 3> face{tet[(i + 1) % 4], tet[(i + 2) % 4], tet[(i + 3) % 4]};
      std::ranges::sort(face);
      ++faces[face].all;
      if (std::abs(volume) > kFlat) ++faces[face].solid;
    }
  }
  for (const auto& [face, count] : faces) {
    if (count.all > 2 && count.solid > 2) ++out.crowded_faces;
    if (count.all != 1) continue;
    ++out.border_faces;
    out.border_area +=
        0.5 * glm::length(glm::cross(points[face[1]] - points[face[0]], points[face[2]] - points[face[0]]));
    out.border.push_back(face);
  }
  return out;
}

double enclosed_volume(std::span<const std::array<Vec3, 3>> triangles) {
  double six = 0.0;
  for (const auto& t : triangles) six += glm::dot(t[0], glm::cross(t[1], t[2]));
  return six / 6.0;
}

}  // namespace palpate::test
