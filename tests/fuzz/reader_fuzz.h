/// A loader's library in process: opens the input and reads every array of every block at every time.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <optional>

#include "common/base/error.h"
#include "common/load/find_format.h"
#include "common/load/helper/serve.h"
#include "tests/fuzz/memory_path.h"

namespace palpate::test {

/// @param make makes the loader; @param mine says whether it is the one for a format.
/// @param diffusion whether tensors are asked for.
template <typename Make, typename Mine>
int read_files(const std::filesystem::path& file, const Make& make, const Mine& mine,
               const std::optional<DiffusionRequest>& diffusion = {}) {
  try {
    const Format format = find_format(file);
    if (!mine(format)) return 0;
    const auto loader = make();
    LoadRequest request;
    request.files = {file};
    request.diffusion = diffusion;
    const FileInfo info = loader->open(request, format);
    std::vector<std::string> names;
    for (const BlockInfo& block : info.blocks) {
      for (const ArrayInfo& array : block.arrays) names.push_back(array.name);
    }
    for (std::size_t step = 0; step < std::max<std::size_t>(1, std::min<std::size_t>(3, info.times.size()));
         ++step) {
      for (const DataSet& block : loader->read(names, step)) {
        for (const DataArray& array : block.arrays) {
          volatile double last = array.tuples > 0 ? array.at(array.tuples - 1, array.components - 1) : 0.0;
          (void)last;
        }
      }
    }
  } catch (const Error&) {
  } catch (const std::bad_alloc&) {  // which a helper answers with a line
  }
  return 0;
}

/// The same for an input that is one file, in memory.
template <typename Make, typename Mine>
int read_everything(const std::uint8_t* data, std::size_t size, const Make& make, const Mine& mine,
                    const std::optional<DiffusionRequest>& diffusion = {}) {
  const MemoryPath input(data, size);
  return read_files(input.path(), make, mine, diffusion);
}

}  // namespace palpate::test
