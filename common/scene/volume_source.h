/// What a picture of a volume is made from: one block along straight axes with one number a point.
#pragma once

#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/scalar_choice.h"

namespace palpate {

/// Makes uniform grids of blocks whose points lie evenly: coordinates at even steps, and points of curvilinear blocks at
/// those of a lattice, to a thousandth of a step. Their arrays stay as they are.
void take_lattices(std::vector<DataSet>& blocks);

/// Whether the data is one image or rectilinear grid: what volumes are drawn from as it is.
[[nodiscard]] bool is_one_lattice(const std::vector<DataSet>& blocks);

/// The uniform or rectilinear block of `blocks` with `choice` as a point array of one component, its only one. Numbers of an
/// array of one component stay where they are; of cells they stand at the middles of the cells, where they
/// are voxels, hidden ones not visible; magnitudes are computed, in single precision.
/// @throws Error (bad input) with `file` where the data is no such block with that array.
[[nodiscard]] DataSet volume_source(const std::vector<DataSet>& blocks, const ScalarChoice& choice,
                                    const std::string& file);

}  // namespace palpate
