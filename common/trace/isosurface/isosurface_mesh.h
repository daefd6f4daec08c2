/// Isosurfaces as triangles, to be drawn: the same surface that isosurface.h lets a hand feel.
///
/// Marching tetrahedra (Doi and Koide 1991): a corner lies above where s >= s_0, so that plateaus have a
/// border, too, and every tetrahedron is cut by none, one or two triangles, without ambiguous cases. Boxes
/// are split in six along the diagonal from the lowest to the highest corner (Kuhn 1960), which makes the
/// diagonals of shared faces agree. A vertex lies where the field's own interpolant equals s_0 on its edge:
/// exact on the edges of tetrahedra and boxes, where that is linear; by a bracketed root (root.h) on the
/// diagonals of boxes and in formulas. So every vertex lies on the surface that is felt, and between them the
/// mesh leaves it by O(h^2). Each edge belongs to two triangles, to one at the border of the data and beside
/// cells with values that are not finite, which are left out. A triangle may have no area where a grid point
/// has the very value s_0.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/base/progress.h"
#include "common/field/scalar_field.h"
#include "common/math/vec.h"

namespace palpate {

struct IsosurfaceMesh {
  double level = 0.0;        ///< s_0, data units
  std::vector<Vec3> points;  ///< data coordinates
  /// One a point, unit: towards higher values, the mean of the gradients in the cells around, weighted by the
  /// areas of their triangles. Zero where no triangle around has an area.
  std::vector<Vec3f> normals;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise as seen from higher values
  /// On grids of boxes: every so many points were taken along each axis, for the limit's sake. Vertices lie
  /// on the surface all the same.
  int stride = 1;
};

/// @param level data units.
/// @param most_triangles above which boxes are taken coarser, stride by stride. Memory: at most 12 bytes a
/// triangle, 84 a vertex (about half as many), and 42 a point of one slice of boxes, or 64 more a vertex on
/// tetrahedra; a coarser pass holds a copy of its values.
/// @param progress may be null.
/// @throws Error (work failed) for more triangles than that on tetrahedra, which cannot be coarsened;
/// Cancelled.
[[nodiscard]] IsosurfaceMesh make_isosurface_mesh(const ScalarField& field, double level,
                                                  std::size_t most_triangles, Progress* progress = nullptr);

}  // namespace palpate
