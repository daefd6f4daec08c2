/// Edges of convex shapes, to be drawn as lines.
#pragma once

#include <vector>

#include "common/math/vec.h"
#include "common/render/lens/lens.h"

namespace palpate {

/// Closed lines: of a ball or ellipsoid three circles, of half-spaces the borders of their faces within `bounds`. Data
/// coordinates. Of cylinders, whose shape is both, the faces alone.
[[nodiscard]] std::vector<std::vector<Vec3>> shape_wire(const ConvexShape& shape, const Box& bounds);

}  // namespace palpate
