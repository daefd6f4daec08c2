/// Thin walls (baffles): faces of cells back to back, with points of their own on either side, in a mesh whose
/// cells share their points elsewhere.
///
/// Nothing in a file tells such a wall from a seam, at which points are doubled because pieces of a mesh were put
/// into one list or because a grid closes on itself. What decides, within one block:
/// - cells that all have points of their own, or stand in many small groups that do ("exploded"), meet at seams;
/// - faces with a rim, whose points both sides share, are a wall that ends in the fluid, whatever flows there,
///   unless their other points are but nearly at the same places, as where rounding kept them from being joined;
/// - others are seams where flow goes through them, alike on both sides, and walls where none does.
/// Faces that do not match corner by corner (hanging nodes, sliding interfaces, overlaps) are seams, and so are
/// those between blocks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/vector_field.h"

namespace palpate {

/// A split mesh, with what the search for walls needs to know of it.
struct SplitCells {
  const TetMesh& mesh;
  std::span<const std::uint32_t> source_cell;  ///< of each cell of the mesh, counted through all blocks
  std::span<const std::uint32_t> first_cell;   ///< of each block
  std::span<const std::uint32_t> place;        ///< for each point, the first at its place
};

/// The velocity of a source cell at one of its points, or of the whole of it.
using VelocityBeside = std::function<Vec3(std::uint32_t source_cell, std::uint32_t point)>;

class ThinWalls {
 public:
  ThinWalls() = default;
  /// @param of what the velocities belong to.
  ThinWalls(const SplitCells& cells, const VelocityBeside& velocity, Association of, int threads);

  /// For each point of the mesh whether it is one of several at a wall; empty where there are no walls.
  [[nodiscard]] std::span<const std::uint8_t> points() const noexcept { return points_; }
  /// Closes the faces of `mesh` that are walls: that of the search, or another one of the same cells.
  void close_faces(TetMesh& mesh, std::span<const std::uint32_t> source_cell) const;
  /// What was taken for a wall, and what was not.
  void note(FieldNotes& notes) const;

 private:
  std::vector<std::uint8_t> points_;
  std::vector<std::uint64_t> parted_;  ///< pairs of source cells, sorted
  std::size_t wall_faces_ = 0;         ///< tetrahedra's, counted on either side, as are the next
  std::size_t flowed_through_ = 0;     ///< of these, with a rim though flow goes through
  std::size_t seam_faces_ = 0;         ///< of parts that flow joins
  std::size_t own_points_ = 0;         ///< of cells with points of their own
};

}  // namespace palpate
