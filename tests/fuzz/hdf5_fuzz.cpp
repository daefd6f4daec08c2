// A loader on HDF5 over files whose content is wrong (hdf5_edits.h): the first byte of an input chooses the template, six a time
// edit it. The build names how the loader is made, and its format.
#include "tests/fuzz/hdf5_edits.h"
#include "tests/fuzz/reader_fuzz.h"

namespace palpate {
[[nodiscard]] std::unique_ptr<Loader> PALPATE_FUZZ_MAKE();
}

using namespace palpate;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto templates = test::templates_in(PALPATE_FUZZ_TEMPLATES);
  const test::FuzzBytes file = test::edited_template(templates, data, size);
  const test::MemoryPath input(file.data(), file.size());
  return test::read_files(input.path(std::string("input") + PALPATE_FUZZ_ENDING), PALPATE_FUZZ_MAKE,
                          [](Format format) { return format == Format::PALPATE_FUZZ_FORMAT; });
}
