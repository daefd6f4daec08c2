/// Lattices of points that stand in memory one after another, x fastest.
#pragma once

#include <cstddef>

#include "common/base/index.h"
#include "common/math/vec.h"

namespace palpate {

/// How many points a lattice of n.x * n.y * n.z has; 0 where an axis has none. @rt Safe.
[[nodiscard]] inline std::size_t count_of(const Index3& n) noexcept {
  if (n.x <= 0 || n.y <= 0 || n.z <= 0) return 0;
  return as_size(n.x) * as_size(n.y) * as_size(n.z);
}

/// Where the point `at` stands in a lattice of n.x * n.y * n.z. @pre 0 <= at < n. @rt Safe.
[[nodiscard]] inline std::size_t index_in(const Index3& n, const Index3& at) noexcept {
  return as_size(at.x) + as_size(n.x) * (as_size(at.y) + as_size(n.y) * as_size(at.z));
}

}  // namespace palpate
