#include "common/scene/tensor_image.h"

#include <algorithm>
#include <utility>

#include "common/base/error.h"

namespace palpate {
namespace {

TensorOrder order_of(TensorLayout layout, int components) {
  if (components == 9) return TensorOrder::kFull;
  if (components == 7) return TensorOrder::kMask;
  return layout == TensorLayout::kLower ? TensorOrder::kLower : TensorOrder::kRows;
}

}  // namespace

TensorImage make_tensor_image(std::vector<DataSet> blocks, const TensorSource& source,
                              const DiffusionInfo& diffusion, const std::string& file, int /*threads*/,
                              Progress* progress) {
  if (progress != nullptr) progress->check();
  const auto block = std::find_if(blocks.begin(), blocks.end(), [&](const DataSet& candidate) {
    return candidate.find(source.arrays.front(), Association::kPoint) != nullptr;
  });
  if (block == blocks.end())
    throw input_error({file, "", "array '" + source.arrays.front() + "' is missing", "", ""});
  TensorImage result;
  result.image = std::move(*block);
  const DataArray& array = *result.image.find(source.arrays.front(), Association::kPoint);
  result.choice = {.array = array.name, .order = order_of(diffusion.layout, array.components)};
  return result;
}

}  // namespace palpate
