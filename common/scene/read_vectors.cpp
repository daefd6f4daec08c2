#include "common/scene/read_vectors.h"

#include <utility>

#include "common/field/constant_cells.h"

namespace palpate {

std::vector<DataSet> read_vectors(Input& input, VectorChoice& choice, Progress* progress) {
  std::vector<DataSet> blocks = input.read(choice.arrays, progress);
  if (input.spec().cell_values != "constant" || choice.association != Association::kCell) return blocks;
  ConstantCells constant = constant_cells(blocks, choice);
  choice = std::move(constant.choice);
  return std::move(constant.blocks);
}

}  // namespace palpate
