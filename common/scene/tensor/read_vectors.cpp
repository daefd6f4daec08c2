#include "common/scene/tensor/read_vectors.h"

#include <algorithm>
#include <set>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/cells/coincident_points.h"
#include "common/field/cells/constant_cells.h"

namespace palpate {
namespace {

/// What is lost where cells are parted that have walls of no thickness between them; empty where nothing is.
std::string lost_walls(const std::vector<DataSet>& blocks, const VectorChoice& choice) {
  if (std::ranges::none_of(blocks, [](const DataSet& block) {
        return std::holds_alternative<UnstructuredTopology>(block.topology);
      }))
    return {};
  const auto velocity = [&](const DataSet& block, std::size_t cell) {
    Vec3 v{0.0};
    for (int c = 0; c < 3; ++c) {
      const bool whole = choice.kind != VectorChoice::Kind::kComponents && choice.arrays.size() < 3;
      const std::size_t which = whole ? 0 : as_size(c);
      if (which >= choice.arrays.size()) continue;
      const DataArray* const array = block.find(choice.arrays[which], Association::kCell);
      if (array != nullptr && (!whole || c < array->components)) v[c] = array->at(cell, whole ? c : 0);
    }
    return v;
  };
  std::set<std::uint32_t> beside;
  try {
    const auto grid =
        make_field_grid(blocks, "", 1, {.association = Association::kCell, .of = velocity, .velocity = true});
    if (!grid->tets) return {};
    for (std::size_t cell = 0; cell < grid->tets->cells().size(); ++cell) {
      for (int face = 0; face < 4; ++face) {
        if (grid->tets->closed(static_cast<CellIndex>(cell), face)) beside.insert(grid->source_cell[cell]);
      }
    }
  } catch (const Error&) {
    return {};  // that of the cells as they are parted is told
  }
  if (beside.empty()) return {};
  return "warning: flow goes through walls of no thickness (" + counted(beside.size(), "cell") +
         " beside them), which are not heeded where cells are constant: --cell-values recovered heeds them";
}

}  // namespace

std::vector<DataSet> read_vectors(Input& input, VectorChoice& choice, Progress* progress,
                                  std::vector<std::string>* notes) {
  std::vector<DataSet> blocks = input.read(choice.arrays, progress);
  if (input.spec().cell_values != "constant" || choice.association != Association::kCell) return blocks;
  if (notes != nullptr) {
    if (std::string lost = lost_walls(blocks, choice); !lost.empty()) notes->push_back(std::move(lost));
  }
  ConstantCells constant = constant_cells(blocks, choice);
  choice = std::move(constant.choice);
  return std::move(constant.blocks);
}

}  // namespace palpate
