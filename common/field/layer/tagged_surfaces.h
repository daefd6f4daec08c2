/// Surfaces of a wall that its mesh names.
#pragma once

#include <vector>

#include "common/field/data_set.h"
#include "common/field/field_grid.h"
#include "common/field/layer/wall_border.h"
#include "common/field/layer/wall_surfaces.h"

namespace palpate {

/// Of the grid's points. @param array kSurfaceArray, of the input's points.
[[nodiscard]] std::vector<WallSurface> tagged_points(const FieldGrid& grid, const DataArray& array);

/// Roles of triangles by the tags of their points, as find_wall_surfaces() says.
[[nodiscard]] std::vector<BorderRole> tagged_roles(const WallBorder& border,
                                                   const std::vector<WallSurface>& of_point);

}  // namespace palpate
