/// Surfaces of a wall that its mesh names.
#pragma once

#include "common/field/data_set.h"
#include "common/field/field_grid.h"
#include "common/field/layer/wall_border.h"
#include "common/field/layer/wall_surfaces.h"

namespace palpate {

/// Surfaces by the numbers of points, as find_wall_surfaces() says. Where a right endocardium is named and no septum, the
/// side of its septum is found by the way through the wall. In doubt are surfaces that lie the other way round, and
/// those that leave much of the border out.
/// @param array kSurfaceArray of the input's points.
[[nodiscard]] WallSurfaces tagged_surfaces(const FieldGrid& grid, const WallBorder& border,
                                           const DataArray& array);

}  // namespace palpate
