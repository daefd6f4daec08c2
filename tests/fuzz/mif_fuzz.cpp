// MRtrix's images, read as diffusion-weighted series: their header, layout and gradients.
#include "loaders/mif/mif_loader.h"
#include "tests/fuzz/reader_fuzz.h"

using namespace palpate;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return test::read_everything(
      data, size, make_mif_loader, [](Format format) { return format == Format::kMrtrixImage; },
      DiffusionRequest{});
}
