/// Splitting curvilinear and mixed cells into tetrahedra so that shared faces agree.
///
/// Both cells beside a face see the same keys of its vertices, so they agree on the diagonals (cell_split.h).
/// In structured blocks the key puts points with even i + j + k first, which gives five tetrahedra a
/// hexahedron; where no such order exists it is the point's index.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/grid/block_join.h"
#include "common/field/grid/tet_mesh.h"

namespace palpate {

/// Tetrahedra of one or several joined blocks, with the way back to the data.
struct SplitMesh {
  std::vector<Vec3> points;                ///< data coordinates; coincident block borders merged
  std::vector<TetMesh::Tet> tets;          ///< not yet oriented
  std::vector<std::uint32_t> source_cell;  ///< for each tet, its cell, counted through all blocks
  /// For each input point, counted through all blocks, its point here; kNoPoint where no cell uses it.
  std::vector<std::uint32_t> point_of_input;
  std::size_t dropped_cells = 0;   ///< cells with no volume to split (points, lines, surfaces)
  std::size_t unknown_cells = 0;   ///< cells of a type that cannot be split, left out
  std::size_t blanked_cells = 0;   ///< cells with a blanked point or one that is not finite, left out
  std::size_t inverted_cells = 0;  ///< cells that are turned inside out as a whole: turned back
  std::size_t folded_cells = 0;    ///< cells with tetrahedra of either orientation: they overlap themselves
  std::size_t corner_cells = 0;    ///< higher-order cells taken through their corners alone
  std::size_t refined_cells = 0;   ///< quadratic cells split into eight linear ones
  std::size_t merged_points = 0;   ///< points joined with one at the same place
  std::size_t repeated_tets = 0;   ///< tetrahedra that several blocks hold (ghost cells), left out
  std::size_t left_handed_blocks = 0;  ///< blocks most of whose cells turn the other way; not errors
};

/// How points are joined.
struct SplitJoins {
  PointsAgree agree;  ///< of different blocks, and of the seams of one
  /// Where not empty: for each point, counted through all blocks, the one that stands for it, in place of what
  /// is found at the borders of blocks.
  std::vector<std::uint32_t> first_of;
};

/// Ten-node tetrahedra and 27-node hexahedra become eight linear cells each where all cells of all blocks
/// are of that one type; in other meshes higher-order cells are taken through their corners, so that their
/// faces agree with their neighbours'. Cells are oriented positively: a cell type of which a block holds
/// mostly negative ones has the other vertex order (left-handed blocks, wedges) and is no error.
/// @throws Error (bad input) with `file` where sizes disagree, a cell names a point that does not exist, or
/// nothing three-dimensional is left.
[[nodiscard]] SplitMesh split_into_tetrahedra(std::span<const DataSet> blocks, const std::string& file,
                                              const SplitJoins& joins = {});

}  // namespace palpate
