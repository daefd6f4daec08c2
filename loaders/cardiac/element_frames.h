/// Directions at several places of each tetrahedron, brought to its points.
///
/// CardioMechanics' .bases files have five frames an element: at the centroid, and at the points of the quadrature of
/// degree two, of which point i has the barycentric coordinate a = (5 + 3 sqrt 5) / 20 to corner i and
/// b = (5 - sqrt 5) / 20 to the others (CBElementSolidT10 of CardioMechanics, KIT). The outer product of a direction, which
/// has no sign, is linear in the element where it is D_i at point i and
///
///   C_i = (D_i - b sum_k D_k) / (a - b)
///
/// at corner i. A point has the mean of its elements, weighted by their volume, and the direction there is the major
/// eigenvector.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/field/data_set.h"

namespace palpate {

inline constexpr int kFramePlaces = 5;  ///< the centroid and four points of a quadrature

/// Adds point arrays "fibre", "sheet" and "normal"; NaN where no element around has a direction.
/// @param further of each element 9 numbers at each of its four quadrature points: fibre, sheet, normal. Elements with a
/// zero or NaN among these directions have no say in that direction.
/// @param topology tetrahedra of 4 or 10 points; those on edges have the mean of both corners.
void add_point_frames(std::span<const double> further, const UnstructuredTopology& topology, DataSet& mesh,
                      std::vector<std::string>& notes);

}  // namespace palpate
