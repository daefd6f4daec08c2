// The NRRD loader with Teem behind it.
#include "loaders/nrrd/nrrd_loader.h"
#include "tests/fuzz/reader_fuzz.h"

using namespace palpate;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return test::read_everything(data, size, make_nrrd_loader,
                               [](Format format) { return format == Format::kNrrd; });
}
