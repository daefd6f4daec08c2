/// What a field is at the points of an OpenFOAM mesh's boundary, from the values that its patches have face by face.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/math/vec.h"
#include "loaders/vtk/foam/foam_boundary.h"

namespace palpate {

/// The values of a field at the points of the boundary, `components` a point, NaN where none is given: the mean of what
/// the faces around say, weighted by the inverse distance of their middles (as OpenFOAM's volPointInterpolation does),
/// whatever their patches.
///
/// A face says its own value and, along it, the gradient over the faces of its patch that it shares points with (least
/// squares), so that linear fields are met at the edges of patches, too. A component whose values lie about no plane there
/// (a jump) has less of the gradient, or none; no gradient makes more than its faces differ.
/// @returns nothing where no point has one. @param positions of all points of the mesh.
[[nodiscard]] std::vector<double> foam_point_values(const std::vector<FoamPatch>& patches,
                                                    const FoamFaces& faces, std::size_t first_face,
                                                    const std::map<std::string, FoamPatchValues>& values,
                                                    int components, const std::vector<Vec3>& positions);

/// At the points of the boundary the sum of n n^T over the faces around through which nothing goes, n their normals, as xx,
/// xy, xz, yy, yz, zz: the faces that a vector slides along. Where a vector of `at_points` would go through a face whose own
/// value does not (the mean of both at the edge of a lid and a wall: a closed box would leak there), the faces with such values, too.
/// Zero elsewhere; nothing where there are no such faces.
/// @param at_points what foam_point_values() gives of the vectors, or nothing.
[[nodiscard]] std::vector<double> foam_point_normals(const std::vector<FoamPatch>& patches,
                                                     const FoamFaces& faces, std::size_t first_face,
                                                     const std::map<std::string, FoamPatchValues>& values,
                                                     const std::vector<Vec3>& positions,
                                                     const std::vector<double>& at_points = {});

/// NaN in `at_points`, as many numbers a point as `of_cells` has a cell, at the corners of cells that have a value which is
/// no number: what a patch gives there would hide that.
void leave_out_bad_cells(const UnstructuredTopology& mesh, const DataArray& of_cells,
                         std::vector<double>& at_points);

}  // namespace palpate
