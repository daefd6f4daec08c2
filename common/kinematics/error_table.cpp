#include "common/kinematics/error_table.h"

#include <algorithm>
#include <array>

#include "common/base/index.h"

namespace palpate {

PoseError ErrorTable::at(const Vec3& p) const noexcept {
  if (values.empty()) return {};
  std::array<std::size_t, 3> first{};
  Vec3 u{0.0};
  for (int axis = 0; axis < 3; ++axis) {
    const double last = count[axis] - 1;
    // NaN compares false and ends at the first node: a table never reads outside itself.
    const double g = (p[axis] - lower[axis]) / spacing[axis];
    const double held = g > 0.0 ? std::min(g, last) : 0.0;
    const double cell = std::min(std::floor(held), last - 1.0);
    first[as_size(axis)] = static_cast<std::size_t>(cell);
    u[axis] = held - cell;
  }
  const auto nx = as_size(count.x), ny = as_size(count.y);
  PoseError sum;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const std::size_t i = corner & 1U, j = (corner >> 1U) & 1U, k = corner >> 2U;
    const double weight = (i ? u.x : 1.0 - u.x) * (j ? u.y : 1.0 - u.y) * (k ? u.z : 1.0 - u.z);
    sum = sum + weight * values[((first[2] + k) * ny + first[1] + j) * nx + first[0] + i];
  }
  return sum;
}

PoseError ErrorSpline::at(const Vec3& p) const noexcept {
  PoseError sum = plane[0] + p.x * plane[1] + p.y * plane[2] + p.z * plane[3];
  for (std::size_t i = 0; i < centers.size(); ++i) sum = sum + glm::distance(p, centers[i]) * weights[i];
  return sum;
}

}  // namespace palpate
