// A loader of one file with its library behind it. The build names how it is made, and its format.
#include "tests/fuzz/reader_fuzz.h"

namespace palpate {
[[nodiscard]] std::unique_ptr<Loader> PALPATE_FUZZ_MAKE();
}

using namespace palpate;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // HDF5 does not survive every damaged structure: hdf5_fuzz.cpp.
  if (size > 3 && data[0] == 0x89 && data[1] == 'H') return 0;
  const bool packed = size > 1 && data[0] == 0x1f && data[1] == 0x8b;
  const test::MemoryPath input(data, size);
  return test::read_files(input.path(std::string("input") + PALPATE_FUZZ_ENDING + (packed ? ".gz" : "")),
                          PALPATE_FUZZ_MAKE,
                          [](Format format) { return format == Format::PALPATE_FUZZ_FORMAT; });
}
