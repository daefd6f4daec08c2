/// Images of levels that refine one another (AMR).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/field/data_set.h"

namespace palpate {

/// Hides the cells of images whose middles lie in one of a finer level: there the finer values count.
/// @param levels of the blocks, 0 the coarsest; negative: of none. @returns how many were hidden.
std::size_t hide_refined_cells(std::vector<DataSet>& blocks, std::span<const int> levels);

}  // namespace palpate
