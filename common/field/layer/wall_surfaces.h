/// The inner and the outer surface of a wall.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/field_grid.h"
#include "common/field/grid/tet_mesh.h"

namespace palpate {

/// The point array by which a loader says which surface a point lies on.
inline constexpr const char* kSurfaceArray = "surface";
/// What it holds.
enum class WallSurface : std::uint8_t { kNone = 0, kInner = 1, kOuter = 2 };

struct WallSurfaces {
  std::vector<WallSurface> of_point;  ///< of the grid's points
  std::string note;                   ///< how they were found, for the user
};

/// Takes them from the array kSurfaceArray where `mesh` has it, else from the shape of the border: it is
/// parted where it bends by more than 40 degrees; parts below 1 % of its area are left out, flat ones (all of
/// a part faces one way within some 8 degrees) are cuts; of the others the one with the largest extent is the
/// outer surface, the rest are inner ones.
/// @throws Error (bad input) with `file` where there are not both: "name them in a point array 'surface'".
[[nodiscard]] WallSurfaces find_wall_surfaces(const FieldGrid& grid, const DataSet& mesh,
                                              const std::string& file);

// The border of a tetrahedral mesh, parted at its creases.

/// A smooth part of the border.
struct BoundaryPatch {
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< points of the mesh, the normal outwards
  double area = 0.0;                                    ///< frame L
  Vec3 normal{
      0.0};    ///< the sum of the triangles' normals over `area`: of unit length where the patch is flat
  Box bounds;  ///< frame L
};

/// Faces of the border belong to one patch where their normals differ by less than `crease` [rad] over the
/// edge that they share. Patches by falling area. Faces of zero-volume cells are border like any others.
[[nodiscard]] std::vector<BoundaryPatch> boundary_patches(const TetMesh& mesh, double crease);

}  // namespace palpate
