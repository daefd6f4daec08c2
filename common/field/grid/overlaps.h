/// Parts of a mesh that overlap (overset grids): which of them counts where.
///
/// The part whose cells are smallest in the mean counts, of equal ones the first. It does so as a whole, not cell
/// by cell: parts have an order then, and no place is left without a cell. Cells of the others that lie wholly in
/// it are covered; those at its border, in it in part, are contested.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/field/grid/tet_mesh.h"

namespace palpate {

/// By cell of the mesh; all empty where no parts overlap.
struct Overlaps {
  std::vector<std::uint32_t> rank;      ///< of its part, from 0, which counts first
  std::vector<std::uint8_t> covered;    ///< its place belongs to parts of lower rank
  std::vector<std::uint8_t> contested;  ///< it is not covered, but cells of a lower rank may lie over it
  std::size_t parts = 0;                ///< that overlap with another one
};
/// @param part of each cell of the mesh, from 0.
[[nodiscard]] Overlaps find_overlaps(const TetMesh& mesh, std::span<const std::uint32_t> part, int threads);

/// For each cell the number of its part, from 0: cells that share vertices, directly or through others.
[[nodiscard]] std::vector<std::uint32_t> connected_parts(const TetMesh& mesh);

}  // namespace palpate
