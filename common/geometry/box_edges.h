/// The edges of a box as lines.
#pragma once

#include <vector>

#include "common/math/vec.h"

namespace palpate {

/// Its twelve edges, of two points each; none of an empty box.
[[nodiscard]] std::vector<std::vector<Vec3>> box_edges(const Box& box);

}  // namespace palpate
