// Everything that looks at a file's bytes before a reader does. The first byte chooses the check, so that one
// corpus serves all.
#include <array>
#include <cstdint>
#include <string_view>

#include "common/load/find_format.h"
#include "common/load/plot3d_layout.h"
#include "loaders/meta/meta_header.h"
#include "loaders/nrrd/nrrd_check.h"
#include "loaders/vtk/ensight_check.h"
#include "loaders/vtk/legacy_check.h"
#include "loaders/vtk/netcdf_check.h"
#include "loaders/vtk/xml_scan.h"

using namespace palpate;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  const auto bytes = std::as_bytes(std::span(text));
  const auto tail = bytes.last(std::min(bytes.size(), kPlot3dTailBytes));
  switch (data[0] % 9) {
    case 0:
      (void)sniff({bytes, tail, bytes.size(), ".ex2"});
      break;
    case 1:
      for (const auto kind : {Plot3dFile::kGrid, Plot3dFile::kSolution}) {
        const auto layout = find_plot3d_layout({bytes, tail, bytes.size()}, kind);
        // A layout that is found must lie inside the file.
        if (layout && layout->data_offset > bytes.size()) __builtin_trap();
        if (layout) (void)describe(*layout, kind);
        (void)may_be_plot3d_text({bytes, tail, bytes.size()}, kind);
        (void)find_plot3d_text_layout(text, kind);
      }
      break;
    case 2:
      (void)scan_legacy(text).problem;
      break;
    case 3:
      (void)scan_xml(text);
      break;
    case 4:
      (void)netcdf_problem(text, text.size());
      break;
    case 5: {
      const NrrdClaims claims = read_nrrd_claims(text);
      if (claims.header_bytes > text.size()) __builtin_trap();
      if (claims.problem.empty()) (void)nrrd_size_problem(claims, text.size() - claims.header_bytes);
      break;
    }
    case 6:
      (void)ensight_variables(text);
      break;
    case 7: {
      const MetaHeader header = read_meta_header(text);
      if (header.header_bytes > text.size()) __builtin_trap();
      if (!header.problem.empty()) break;
      if (header.piece_count != header.pieces.size()) __builtin_trap();
      (void)meta_size_problem(header, text.size() - header.header_bytes);
      break;
    }
    default: {
      XmlTags tags(text);
      XmlTag tag;
      while (tags.next(tag)) {
      }
      if (tags.position() > text.size()) __builtin_trap();
    }
  }
  return 0;
}
