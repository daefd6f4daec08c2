#include "common/kinematics/error_table.h"

#include <algorithm>
#include <array>

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
    first[static_cast<std::size_t>(axis)] = static_cast<std::size_t>(cell);
    u[axis] = held - cell;
  }
  const auto nx = static_cast<std::size_t>(count.x), ny = static_cast<std::size_t>(count.y);
  PoseError sum;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const std::size_t i = corner & 1U, j = (corner >> 1U) & 1U, k = corner >> 2U;
    const double weight = (i ? u.x : 1.0 - u.x) * (j ? u.y : 1.0 - u.y) * (k ? u.z : 1.0 - u.z);
    sum = sum + weight * values[((first[2] + k) * ny + first[1] + j) * nx + first[0] + i];
  }
  return sum;
}

}  // namespace palpate
