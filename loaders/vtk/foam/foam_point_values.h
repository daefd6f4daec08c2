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

/// NaN in `at_points`, as many numbers a point as `of_cells` has a cell, at the corners of cells that have a value which is
/// no number: what a patch gives there would hide that.
void leave_out_bad_cells(const UnstructuredTopology& mesh, const DataArray& of_cells,
                         std::vector<double>& at_points);

}  // namespace palpate
