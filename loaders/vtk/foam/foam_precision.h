/// Numbers of OpenFOAM's files in double precision, in the place of those that VTK's reader rounds to single.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/field/data_set.h"
#include "loaders/vtk/foam/foam_boundary.h"
#include "loaders/vtk/foam/foam_scope.h"

namespace palpate {

/// The internalField of a field of `components` numbers, in text or binary.
/// @throws FoamMalformed where there is none, or it is not written out.
[[nodiscard]] FoamPatchValues read_foam_inner_values(std::string_view text, int components,
                                                     const FoamInclude& include = {});

/// The coordinates in a file polyMesh/points, three a point. @throws Error (bad input) with `file`.
[[nodiscard]] std::vector<double> read_foam_points(std::string_view text, const std::string& file);

/// Whether the file itself has no more than single precision.
[[nodiscard]] bool is_single_precision(std::string_view text);

/// `rounded` with `exact` in place of its numbers; nothing where these are not what `exact` is rounded, so that an
/// order of cells that differs from the file's does no harm.
[[nodiscard]] std::optional<DataArray> in_double(const DataArray& rounded, std::span<const double> exact);

}  // namespace palpate
