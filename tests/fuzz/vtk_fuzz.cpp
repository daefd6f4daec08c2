// The loader of VTK's own formats with VTK behind it (not instrumented, so found by chance, not by coverage).
#include "loaders/vtk/vtk_files.h"
#include "tests/fuzz/reader_fuzz.h"

using namespace palpate;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return test::read_everything(data, size, make_vtk_loader, [](Format format) {
    return format == Format::kLegacyVtk || format == Format::kVtkXml;
  });
}
