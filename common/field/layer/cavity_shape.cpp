#include "common/field/layer/cavity_shape.h"

#include <algorithm>
#include <numbers>

namespace palpate {

double wall_before(const TetMesh& mesh, const WallBorder& border, const std::vector<bool>& cavity,
                   const std::vector<bool>& outer) {
  const WallCrossing crossing(mesh, border);
  double sum = 0.0, all = 0.0;
  for (std::size_t t = 0; t < cavity.size(); ++t) {
    if (!cavity[t]) continue;
    const std::size_t met = crossing.from(t);
    if (met >= outer.size() || !outer[met]) continue;
    const double area = glm::length(border.areas[t]);
    sum += area * glm::distance(triangle_middle(mesh.points(), border.triangles[t]),
                                triangle_middle(mesh.points(), border.triangles[met]));
    all += area;
  }
  return all > 0.0 ? sum / all : 0.0;
}

double roundness(const TetMesh& mesh, const WallBorder& border, const std::vector<bool>& cavity) {
  Vec3 middle{0.0}, area{0.0};
  double count = 0.0, total = 0.0, volume = 0.0;
  for (const auto& [a, b] : border.joints) {
    if (cavity[a] == cavity[b]) continue;
    for (const std::uint32_t corner : border.triangles[a]) {
      if (std::ranges::find(border.triangles[b], corner) == border.triangles[b].end()) continue;
      middle += mesh.points()[corner];
      count += 1.0;
    }
  }
  if (count > 0.0) middle /= count;  // of a closed cavity any place will do
  for (std::size_t t = 0; t < cavity.size(); ++t) {
    if (!cavity[t]) continue;
    total += glm::length(border.areas[t]);
    area += border.areas[t];
    volume -= glm::dot(triangle_middle(mesh.points(), border.triangles[t]) - middle, border.areas[t]) / 3.0;
  }
  total += glm::length(area);  // the plane over the rim
  return volume > 0.0 ? 36.0 * std::numbers::pi * volume * volume / (total * total * total) : 0.0;
}

}  // namespace palpate
