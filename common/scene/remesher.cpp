#include "common/scene/remesher.h"

#include <cstring>
#include <memory>
#include <utility>

#include "common/base/index.h"

namespace palpate {

std::vector<DataArray> carried_arrays(const DataSet& block, const std::vector<std::uint32_t>& point_of_file) {
  std::vector<DataArray> carried;
  for (const DataArray& array : block.arrays) {
    if (array.association != Association::kPoint) continue;
    const std::size_t size = as_size(array.components) * byte_size(array.type);
    // Aligned for every type of number.
    auto bytes = std::make_shared<std::vector<std::max_align_t>>(
        (size * point_of_file.size() + sizeof(std::max_align_t) - 1) / sizeof(std::max_align_t));
    auto* const to = reinterpret_cast<std::byte*>(bytes->data());
    for (std::size_t p = 0; p < point_of_file.size(); ++p)
      std::memcpy(to + size * p, array.bytes.data() + size * point_of_file[p], size);
    DataArray here = array;
    here.tuples = point_of_file.size();
    here.bytes = {to, size * point_of_file.size()};
    here.owner = std::move(bytes);
    carried.push_back(std::move(here));
  }
  return carried;
}

}  // namespace palpate
