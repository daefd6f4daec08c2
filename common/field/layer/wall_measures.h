/// What can be measured on the surfaces of a wall, to see whether they were found rightly.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/field/field_grid.h"
#include "common/field/layer/wall_surfaces.h"

namespace palpate {

/// The share of points from which the depth rises, edge by edge, to the outer surface and falls to an inner one. Corners
/// of a surface that no edge leads into the wall from go with those beside them.
/// @param depth as for measure_wall().
[[nodiscard]] double monotone_share(const FieldGrid& grid, const WallSurfaces& surfaces,
                                    std::span<const double> depth);
/// A WARNING where the share is below 97 %; else empty.
[[nodiscard]] std::string monotone_doubt(double share);

/// A WARNING where the depth that a file gives has its lowest values around its highest ones; else empty.
/// @param depth of the input's points. @pre grid.tets.
[[nodiscard]] std::string inward_doubt(const FieldGrid& grid, const DataArray& depth);

struct WallMeasures {
  /// monotone_share().
  double monotone = 0.0;
  /// Of the wall through each point of the grid, along the gradient of the depth; NaN where there is no depth;
  /// data units.
  std::vector<double> thickness;
  /// @name Over the points of the inner surfaces; data units
  /// @{
  double thinnest = 0.0;
  double median = 0.0;
  double thickest = 0.0;
  /// @}
};

/// @param depth of the grid's points, as solve_laplace() finds it between `surfaces`. @pre grid.tets.
[[nodiscard]] WallMeasures measure_wall(const FieldGrid& grid, const WallSurfaces& surfaces,
                                        std::span<const double> depth);

}  // namespace palpate
