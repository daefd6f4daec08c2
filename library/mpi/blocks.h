/// Pieces of a field by which lines are dealt out to ranks: those in one block lie near one another in space, and
/// what they read lies near in memory.
#pragma once

#include <cstdint>
#include <string>

#include "common/field/vector_field.h"

namespace palpate::mpi {

class Blocks {
 public:
  /// Boxes of about as many cells each, as near to cubes as `count` divides; of a mesh runs of its cells, which stand in
  /// an order that keeps neighbours together. A formula is one block.
  Blocks(const VectorField& field, int count);

  [[nodiscard]] int count() const noexcept { return count_; }
  /// @param cell of LineWalk::cell().
  [[nodiscard]] int block_of(std::int64_t cell) const noexcept;
  /// "64 blocks of 4 x 4 x 4"
  [[nodiscard]] std::string text() const;

 private:
  int count_ = 1;
  Index3 parts_{1};       ///< along the axes
  Index3 cells_{1};       ///< of a box grid
  std::int64_t run_ = 0;  ///< cells of a mesh in a block; 0: no mesh
};

}  // namespace palpate::mpi
