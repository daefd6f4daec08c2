/// How large the surfaces of a wall are, and how well that is known.
#pragma once

#include <string>

#include "common/field/field_grid.h"
#include "common/field/layer/wall_border.h"
#include "common/field/layer/wall_surfaces.h"

namespace palpate {

inline constexpr double kSmallPart = 0.01;  ///< of the border's area: what has no role

/// Areas, pieces and confidence of the roles.
void measure_surfaces(const FieldGrid& grid, const WallBorder& border, WallSurfaces& surfaces);

/// Makes WallSurfaces::of_point of the roles. Where two meet an inner surface counts before an outer one.
void mark_points(const FieldGrid& grid, WallSurfaces& surfaces);

/// "endocardium (area 1200), epicardium (area 2300, 2 pieces), base (area 300)"
[[nodiscard]] std::string areas_text(const WallSurfaces& surfaces);

/// What is in doubt where rims are stairs: they are known to half a voxel. @param step of the voxels, frame L.
[[nodiscard]] std::string doubt_stairs(const FieldGrid& grid, const WallBorder& border,
                                       const WallSurfaces& surfaces, double step);

}  // namespace palpate
