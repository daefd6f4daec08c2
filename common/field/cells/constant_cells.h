/// Values of cells as they are: constant over each cell, with a jump at every face.
#pragma once

#include <vector>

#include "common/field/data_set.h"
#include "common/field/vector_choice.h"

namespace palpate {

struct ConstantCells {
  std::vector<DataSet> blocks;
  VectorChoice choice;  ///< of points
};

/// Blocks of the same cells that share no points: those of a cell have its values. Blocks without an array of the
/// choice stay as they are. What make_vector_field() makes of them is constant within each cell; lines cross from cell
/// to cell where these meet, and the jumps count into their errors. @pre choice.association is kCell.
[[nodiscard]] ConstantCells constant_cells(const std::vector<DataSet>& blocks, const VectorChoice& choice);

}  // namespace palpate
