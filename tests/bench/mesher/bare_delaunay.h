/// CGAL's Delaunay triangulation as it comes.
#pragma once

#include <cstddef>
#include <span>

#include "common/math/vec.h"

namespace palpate {

/// The finite cells that it has; nothing is taken out of it.
[[nodiscard]] std::size_t bare_delaunay_cells(std::span<const Vec3> points);

}  // namespace palpate
