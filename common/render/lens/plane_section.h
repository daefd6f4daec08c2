/// Where a plane meets a convex solid.
#pragma once

#include <span>
#include <vector>

#include "common/math/vec.h"
#include "common/render/lens/lens.h"

namespace palpate {

/// The corners of the polygon in which the border of `plane` meets all of `within`, in order about its
/// normal; empty where it misses them.
/// @param near a point of the solid.
/// @param reach no point of the solid is farther than this from `near`.
/// @pre plane.outward is unit.
[[nodiscard]] std::vector<Vec3> plane_section(const ConvexShape::HalfSpace& plane,
                                              std::span<const ConvexShape::HalfSpace> within,
                                              const Vec3& near, double reach);

/// The same for a box along the axes of the data.
[[nodiscard]] std::vector<Vec3> plane_section(const ConvexShape::HalfSpace& plane, const Box& box);

}  // namespace palpate
