#include "common/load/write/packed_appendix.h"

#include <algorithm>
#include <cstdint>

#include <zlib.h>

#include "common/base/check.h"

namespace palpate {

std::string PackedAppendix::declare(const char* type, std::string_view name, int components,
                                    std::span<const std::byte> array) {
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  std::string text = std::string("<DataArray type=\"") + type + "\" Name=\"" + std::string(name) +
                     "\" NumberOfComponents=\"" + std::to_string(components) +
                     "\" format=\"appended\" offset=\"" + std::to_string(bytes_.size()) + "\"/>\n";
  const std::uint64_t blocks = (array.size() + kBlock - 1) / kBlock;
  std::vector<std::uint64_t> head{blocks, kBlock, array.size() % kBlock};
  std::string packed;
  for (std::size_t first = 0; first < array.size(); first += kBlock) {
    const auto block = array.subspan(first, std::min(kBlock, array.size() - first));
    uLongf size = compressBound(static_cast<uLong>(block.size()));
    const std::size_t before = packed.size();
    packed.resize(before + size);
    const int result = compress2(reinterpret_cast<Bytef*>(packed.data() + before), &size,
                                 reinterpret_cast<const Bytef*>(block.data()),
                                 static_cast<uLong>(block.size()), Z_BEST_SPEED);
    PALPATE_CHECK(result == Z_OK);  // the room is what zlib asks for
    packed.resize(before + size);
    head.push_back(size);
  }
  bytes_.append(reinterpret_cast<const char*>(head.data()), head.size() * sizeof(std::uint64_t));
  bytes_ += packed;
  return text;
}

}  // namespace palpate
