/// The edges of a field's domain, to be drawn around its lines.
#pragma once

#include <vector>

#include "common/field/vector_field.h"
#include "common/math/vec.h"

namespace palpate {

/// Polylines in data coordinates along which the border of a tetrahedral mesh turns sharply; twelve edges of
/// a box grid that is turned against the axes. Empty where the edges of the bounds say the same, or where
/// there are so many sharp edges that they would hide the lines.
[[nodiscard]] std::vector<std::vector<Vec3>> domain_outline(const VectorField& field);

/// The twelve edges of an image: from `lower` to `upper` in its grid coordinates g, at x = origin + axes g.
[[nodiscard]] std::vector<std::vector<Vec3>> image_outline(const Vec3& origin, const Mat3& axes,
                                                           const Vec3& lower, const Vec3& upper);

}  // namespace palpate
