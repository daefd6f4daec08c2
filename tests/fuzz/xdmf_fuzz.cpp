// XDMF with libxdmf behind it. What follows a zero byte chooses and edits the HDF5 file "input.h5" beside the text (hdf5_edits.h).
#include <algorithm>
#include <filesystem>

#include "tests/fuzz/hdf5_edits.h"
#include "tests/fuzz/reader_fuzz.h"

namespace palpate {
[[nodiscard]] std::unique_ptr<Loader> make_xdmf_loader();
}

using namespace palpate;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto text_size = static_cast<std::size_t>(std::find(data, data + size, 0) - data);
  const std::size_t from = std::min(size, text_size + 1);
  static const auto templates = test::templates_in(PALPATE_FUZZ_TEMPLATES);
  const test::FuzzBytes edited = test::edited_template(templates, data + from, size - from);
  const test::MemoryPath text(data, text_size), numbers(edited.data(), edited.size());
  const std::filesystem::path file = text.path("input.xdmf");
  (void)numbers.beside(file.parent_path() / "input.h5");
  return test::read_files(file, make_xdmf_loader, [](Format format) { return format == Format::kXdmf; });
}
