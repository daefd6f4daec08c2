/// The surfaces around a wall, and what TetGen must be told of them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/scene/wall/mesh_job.h"

namespace palpate {

struct WallBorder {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise as seen from outside the wall
  std::vector<Vec3> holes;                              ///< a point in each cavity that the wall closes in
};

/// The faces of the wall's tetrahedra that no other one shares, with their points numbered anew, and a point
/// in every closed cavity: there the triangles of a connected surface enclose what is not wall.
/// @throws Error (bad input) where the wall has no tetrahedron.
[[nodiscard]] WallBorder border_of(const SampledWall& wall);

/// Refuses what TetGen ends the process on: fewer than four triangles, triangles without area or that stand
/// there twice, points at one place, edges that do not have an even number of triangles (an open surface).
/// @throws Error (work failed) that names the first one.
void check_border(const WallBorder& border);

/// How often the border winds around `x`: 1 in the wall, 0 outside, up to rounding (van Oosterom & Strackee,
/// IEEE Trans Biomed Eng 30 (1983) 125).
[[nodiscard]] double winding_number(const WallBorder& border, const Vec3& x);

}  // namespace palpate
