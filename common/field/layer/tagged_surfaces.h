/// Surfaces of a wall that its mesh names.
#pragma once

#include <cstdint>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/field_grid.h"
#include "common/field/layer/wall_border.h"
#include "common/field/layer/wall_surfaces.h"

namespace palpate {

/// The numbers of kSurfaceArray at the grid's points; 0 where there is another one. @param array of the input's points.
[[nodiscard]] std::vector<std::uint8_t> tags_of_points(const FieldGrid& grid, const DataArray& array);

/// Which of both surfaces a point with each tag lies on.
[[nodiscard]] std::vector<WallSurface> tagged_points(const std::vector<std::uint8_t>& tags);

/// Roles of triangles by the tags of their points, as find_wall_surfaces() says.
[[nodiscard]] std::vector<BorderRole> tagged_roles(const WallBorder& border,
                                                   const std::vector<std::uint8_t>& tags);

}  // namespace palpate
