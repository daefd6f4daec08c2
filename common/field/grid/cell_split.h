/// Splitting curvilinear and mixed cells into tetrahedra so that shared faces agree.
///
/// Every quadrilateral (or larger) face is cut by the diagonals through its vertex of the smallest key,
/// and every cell is coned from its vertex of the smallest key over the triangles of the faces that do not
/// hold it (Dompierre et al. 1999). Both cells beside a face see the same keys, so they agree on the
/// diagonals. In structured blocks the key puts points with even i + j + k first, which gives five
/// tetrahedra a hexahedron; where no such order exists it is the point's index.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/grid/tet_mesh.h"

namespace palpate {

/// Tetrahedra of one or several joined blocks, with the way back to the data.
struct SplitMesh {
  std::vector<Vec3> points;                   ///< data coordinates; coincident block borders merged
  std::vector<TetMesh::Tet> tets;             ///< not yet oriented
  std::vector<std::uint32_t> source_cell;     ///< for each tet, its cell, counted through all blocks
  std::vector<std::uint32_t> point_of_input;  ///< for each input point, counted through all blocks
  std::size_t dropped_cells = 0;              ///< cells with no volume to split (points, lines, surfaces)
  std::size_t blanked_cells = 0;              ///< cells with a blanked point, left out
};

/// @throws Error (bad input) with `file` where a cell names a point that does not exist, or nothing
/// three-dimensional is left.
[[nodiscard]] SplitMesh split_into_tetrahedra(std::span<const DataSet> blocks, const std::string& file);

}  // namespace palpate
