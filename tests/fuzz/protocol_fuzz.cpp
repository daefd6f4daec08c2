// An explorer's reading of a helper's answer: JSON, a zero byte, then the memory that it speaks of. What is
// accepted is used as the explorers use it.
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include "common/base/error.h"
#include "common/load/helper/protocol.h"

using namespace palpate;

namespace {

void use(const DataSet& block) {
  volatile double sum = 0.0;
  for (const DataArray& array : block.arrays) {
    for (std::size_t t = 0; t < array.tuples; ++t) sum = sum + array.at(t, array.components - 1);
  }
  if (const auto* mesh = std::get_if<UnstructuredTopology>(&block.topology)) {
    for (std::size_t c = 0; c < mesh->types.size(); ++c) {
      if (mesh->types[c] == 42) continue;
      for (std::int64_t i = mesh->offsets[c]; i < mesh->offsets[c + 1]; ++i) {
        sum = sum + mesh->positions.at(
                        static_cast<std::size_t>(mesh->connectivity[static_cast<std::size_t>(i)]), 2);
      }
    }
  }
  if (!block.visible.empty() && block.visible.size() != block.point_count()) __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto* end = static_cast<const std::uint8_t*>(std::memchr(data, 0, size));
  const std::size_t length = end == nullptr ? size : static_cast<std::size_t>(end - data);
  const std::string_view text(reinterpret_cast<const char*>(data), length);
  // A copy, so that reading past its end is noticed and its start is aligned as mapped memory is.
  const std::size_t rest = size - std::min(size, length + 1);
  std::vector<std::byte> memory(rest);
  if (rest > 0) std::memcpy(memory.data(), data + length + 1, rest);
  try {
    for (const DataSet& block : decode_blocks(text, memory, nullptr)) use(block);
  } catch (const std::runtime_error&) {
  }
  try {
    (void)decode_info(text);
  } catch (const std::runtime_error&) {
  }
  try {
    (void)decode_request(text);
  } catch (const std::runtime_error&) {
  }
  return 0;
}
