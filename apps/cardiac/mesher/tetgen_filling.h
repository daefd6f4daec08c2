/// Tetrahedra between the border surfaces of a wall, by TetGen (Si, ACM Trans Math Softw 41 (2015) 11): the
/// triangles of the surfaces stay as they are, points are added inside only.
#pragma once

#include <vector>

#include "apps/cardiac/mesher/border.h"
#include "common/scene/wall/mesh_job.h"

namespace palpate {

/// Radius over shortest edge that no tetrahedron exceeds where TetGen can help it.
inline constexpr double kRadiusEdge = 1.414;

/// @param largest_volume of a tetrahedron; 0: no limit.
/// @throws Error (work failed) for surfaces that cross or touch, and where TetGen gives nothing. TetGen may
/// end the process on input that check_border() did not find fault with: call it in a helper program only.
[[nodiscard]] FinishedMesh fill_border(const WallBorder& border, double largest_volume);

}  // namespace palpate
