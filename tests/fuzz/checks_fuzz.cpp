// Everything that looks at a file's bytes before a reader does. The first byte chooses the check, so that one
// corpus serves all.
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/error.h"
#include "common/load/find_format.h"
#include "common/load/plot3d_layout.h"
#include "loaders/cfd/cfd_check.h"
#include "loaders/cfd/fluent_faces.h"
#include "loaders/meta/meta_header.h"
#include "loaders/nrrd/nrrd_check.h"
#include "loaders/vtk/ensight/ensight_check.h"
#include "loaders/vtk/ensight/ensight_rows.h"
#include "loaders/vtk/foam/foam_baffles.h"
#include "loaders/vtk/foam/foam_boundary.h"
#include "loaders/vtk/foam/foam_collated.h"
#include "loaders/vtk/foam/foam_point_values.h"
#include "loaders/vtk/foam/foam_precision.h"
#include "loaders/vtk/legacy_check.h"
#include "loaders/vtk/netcdf_check.h"
#include "loaders/vtk/xml_scan.h"
#include "loaders/xdmf/xdmf_text.h"

using namespace palpate;

namespace {

/// Each of OpenFOAM's files that are read here, and what comes of them together.
void read_foam(std::string_view text) {
  try {
    for (const std::string& block : part_foam_blocks(text)) {
      if (block.find("FoamFile") == std::string::npos) __builtin_trap();
    }
  } catch (const FoamMalformed&) {
  }
  if (const auto [first, count] = foam_processors_of(text.substr(0, text.find('\n'))); first < 0 || count < 0)
    __builtin_trap();
  std::vector<FoamPatch> patches{{"lid", {"wall"}, 2, 1}, {"floor", {}, 1, 3}};
  try {
    patches = read_foam_patches(text, "boundary");
  } catch (const Error&) {
  }
  FoamFaces faces{{0, 3, 6, 9}, {0, 1, 2, 1, 2, 3, 0, 2, 3}};
  try {
    faces = read_foam_faces(text, 1, "faces");
    if (faces.begin.back() > faces.points.size()) __builtin_trap();
  } catch (const Error&) {
  }
  std::vector<std::int64_t> owner{0, 1, 0, 1};
  try {
    owner = read_foam_labels(text, "owner");
  } catch (const Error&) {
  }
  if (FoamBaffles::any(faces, 0, patches)) {
    const FoamBaffles baffles(faces, patches, owner, {}, 4);
    if (baffles.points() < 4 || baffles.point_of(0, 1) < 0) __builtin_trap();
  }
  try {
    if (read_foam_points(text, "points").size() % 3 != 0) __builtin_trap();
  } catch (const Error&) {
  }
  for (const int components : {1, 3}) {
    try {
      const FoamPatchValues values = read_foam_inner_values(text, components);
      const DataArray rounded = make_array("p", Association::kCell, components, std::vector<float>(6, 1.0F));
      if (in_double(rounded, values.numbers) && values.numbers.size() != 6) __builtin_trap();
    } catch (const FoamMalformed&) {
    } catch (const Error&) {
    }
  }
  const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const int components : {1, 3}) {
    std::vector<std::string> problems;
    const auto values = read_foam_boundary(text, components, patches, problems);
    const auto points = foam_point_values(patches, faces, 1, values, components, positions);
    if (!points.empty() && points.size() != positions.size() * static_cast<std::size_t>(components))
      __builtin_trap();
    const auto normals = foam_point_normals(patches, faces, 1, values, positions);
    if (!normals.empty() && normals.size() != 6 * positions.size()) __builtin_trap();
  }
}

/// Polyhedra of Fluent from whatever faces: two cells of four and five points.
void read_fluent(std::string_view text) {
  const FluentFaces faces = read_fluent_faces(text);
  if (!faces.problem.empty()) return;
  if (faces.begin.size() != faces.cells.size() + 1 || faces.begin.back() != faces.points.size())
    __builtin_trap();
  UnstructuredTopology mesh;
  mesh.types = {41, 41, 10};
  mesh.offsets = {0, 4, 9, 13};
  mesh.connectivity = {0, 1, 2, 3, 1, 2, 3, 4, 5, 0, 1, 2, 4};
  if (!restore_polyhedra(mesh, faces).empty()) return;
  if (mesh.types[0] != 42 || mesh.offsets.back() != static_cast<std::int64_t>(mesh.connectivity.size()))
    __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  const auto bytes = std::as_bytes(std::span(text));
  const auto tail = bytes.last(std::min(bytes.size(), kPlot3dTailBytes));
  switch (data[0] % 13) {
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
      (void)ensight_unused(text, {});
      break;
    case 7: {
      const MetaHeader header = read_meta_header(text);
      if (header.header_bytes > text.size()) __builtin_trap();
      if (!header.problem.empty()) break;
      if (header.piece_count != header.pieces.size()) __builtin_trap();
      (void)meta_size_problem(header, text.size() - header.header_bytes);
      break;
    }
    case 9:
      read_foam(text);
      break;
    case 10:
      (void)fluent_problem(text);
      read_fluent(text);
      break;
    case 11:
      (void)gambit_problem(text);
      break;
    case 12:
      for (const std::string& name : look_at_xdmf(text).hdf5) {
        if (name.empty() || name.front() == '/') __builtin_trap();
      }
      break;
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
