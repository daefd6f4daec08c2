/// The border of a tetrahedral mesh, parted at its creases.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/field/grid/tet_mesh.h"

namespace palpate {

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
