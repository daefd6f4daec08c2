/// Cells whose place belongs to another block (overlaps.h) are left out of a mesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "common/field/data_set.h"
#include "common/field/grid/cell_split.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/vector_field.h"

namespace palpate {

/// The value of a source cell, counted through all blocks, at one of its points, likewise; or of the whole of it.
using ValueBeside = std::function<Vec3(std::uint32_t source_cell, std::uint32_t input_point)>;

class CoveredCells {
 public:
  /// Takes the covered cells out of `split` and `mesh`, which is made again, and tells `mesh` which cells count where
  /// several hold a point. Blocks are what may overlap, or where there is one, its parts that share no points.
  /// @param value empty where there is none to compare.
  CoveredCells(std::shared_ptr<TetMesh>& mesh, SplitMesh& split, std::span<const DataSet> blocks,
               const ValueBeside& value, int threads);

  /// Whether anything overlaps.
  [[nodiscard]] bool any() const noexcept { return parts_ > 0; }
  /// What counts where, what was left out, and by how much its values differ from those that count.
  void note(FieldNotes& notes) const;

 private:
  bool one_block_;
  std::size_t parts_ = 0;      ///< that overlap
  std::size_t covered_ = 0;    ///< tetrahedra
  std::size_t contested_ = 0;  ///< likewise
  bool compared_ = false;
  double widest_ = 0.0;   ///< difference of values at the middle of a covered cell
  double largest_ = 0.0;  ///< value there
};

}  // namespace palpate
