/// Points and cells that VTK marks as hidden, or as another piece's too (vtkGhostType).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/field/data_set.h"

class vtkDataSet;
class vtkUnstructuredGrid;

namespace palpate {

/// One byte a cell, 1 where it is hidden; none where none is.
[[nodiscard]] std::vector<std::uint8_t> hidden_cells(vtkDataSet* data);

/// One byte a point, 0 where VTK marks it hidden; of hidden cells, the points that no visible cell has.
[[nodiscard]] std::vector<std::uint8_t> visible_points(vtkDataSet* data,
                                                       const std::vector<std::uint8_t>& hidden);

/// Leaves out of `block`, which was made of `grid`, the cells that are hidden or another piece's too, with the points that no
/// other cell has. (vtkUnstructuredGrid::RemoveGhostCells() of VTK 9.1 does not survive polyhedra.)
void leave_out_ghost_cells(vtkUnstructuredGrid* grid, DataSet& block);

/// How many these are.
[[nodiscard]] std::size_t ghost_cell_count(vtkDataSet* data);
/// What is said of so many.
[[nodiscard]] std::string ghost_cells_note(std::size_t count);

}  // namespace palpate
