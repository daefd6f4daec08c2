#include "apps/grid/color_block.h"

#include <utility>
#include <variant>
#include <vector>

#include "common/load/volume_block.h"

namespace palpate {

std::optional<DataSet> color_block(Input& input, Progress* progress) {
  const ScalarChoice choice = input.scalar_choice();
  if (choice.array != kColorArray || choice.component != ScalarChoice::kMagnitude) return std::nullopt;
  std::vector<DataSet> blocks = input.read({choice.array}, progress);
  const bool bytes = blocks.size() == 1 && blocks.front().arrays.size() == 1 &&
                     blocks.front().arrays.front().type == ScalarType::kUint8 &&
                     std::holds_alternative<UniformTopology>(blocks.front().topology);
  if (!bytes) return std::nullopt;
  return std::move(blocks.front());
}

}  // namespace palpate
