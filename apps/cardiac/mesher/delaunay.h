/// The Delaunay tetrahedra of a point set, of which none is flat inside.
///
/// Points of a curvilinear grid are cospherical by construction. Their Delaunay tetrahedra are then not
/// unique, and every choice that is made face by face leaves tetrahedra between four points of a plane: about
/// an eighth of all have no volume but what rounding gives them. So ties are broken in the lifted space: each
/// point gets a weight below kLargestWeight of its spacing squared, drawn from its number, and the regular
/// (weighted Delaunay) triangulation is taken. A tetrahedron of height eta d over corners d apart would then
/// need an empty orthosphere with its centre some kLargestWeight / eta times d away, and there is none.
/// Points stay where they are; predicates are exact; where four points of a plane lie on the hull a flat
/// tetrahedron can remain there (wall_cells.h takes those off). (Edelsbrunner & Muecke, Simulation of
/// simplicity, ACM Trans Graph 9 (1990) 66, do the same by symbols; a symbolic perturbation does not tell
/// flat tetrahedra from others.)
#pragma once

#include <span>
#include <vector>

#include "common/field/grid/tet_mesh.h"
#include "common/math/vec.h"

namespace palpate {

/// Of a point, over the square of its spacing. It moves the border between two points' cells by half of that
/// part of their distance, and is some 1e6 times the rounding of coordinates.
inline constexpr double kLargestWeight = 1e-7;

struct DelaunayCells {
  std::vector<TetMesh::Tet> tets;             ///< positively oriented
  std::vector<TetMesh::Neighbors> neighbors;  ///< [i] behind the face opposite corner i; kNoCell on the hull
};

/// @param spacing of each point: the distance to the nearest other one, roughly; > 0.
/// @throws Error (work failed) where the points lie in one plane.
[[nodiscard]] DelaunayCells delaunay_cells(std::span<const Vec3> points, std::span<const double> spacing);

}  // namespace palpate
