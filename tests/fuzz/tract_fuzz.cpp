// The tractogram loader: .tck, .trk and zipped .trx.
#include "loaders/tract/tract_loader.h"
#include "tests/fuzz/reader_fuzz.h"

using namespace palpate;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return test::read_everything(data, size, make_tract_loader, [](Format format) {
    return format == Format::kTck || format == Format::kTrk || format == Format::kTrx;
  });
}
