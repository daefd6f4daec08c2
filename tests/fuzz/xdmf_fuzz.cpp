// XDMF with libxdmf behind it. What follows a zero byte is the HDF5 file "input.h5" beside the text.
#include <algorithm>
#include <filesystem>

#include "tests/fuzz/reader_fuzz.h"

namespace palpate {
[[nodiscard]] std::unique_ptr<Loader> make_xdmf_loader();
}

using namespace palpate;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto text_size = static_cast<std::size_t>(std::find(data, data + size, 0) - data);
  const std::size_t from = std::min(size, text_size + 1);
  const test::MemoryPath text(data, text_size), numbers(data + from, size - from);
  const std::filesystem::path file = text.path("input.xdmf");
  std::filesystem::create_symlink(numbers.path(), file.parent_path() / "input.h5");
  return test::read_files(file, make_xdmf_loader, [](Format format) { return format == Format::kXdmf; });
}
