#include "common/load/format.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/load/dicom_mark.h"
#include "common/load/gzip_head.h"
#include "common/load/plot3d_layout.h"

namespace palpate {
namespace {

/// @name What recognisers look at.
/// @{

/// The bytes as text, without the byte order mark of UTF-8.
std::string_view text_of(const FileHead& head) {
  std::string_view text(reinterpret_cast<const char*>(head.bytes.data()), head.bytes.size());
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  return text;
}

/// The same from its first character that is no blank.
std::string_view text_after_blanks(const FileHead& head) {
  const std::string_view text = text_of(head);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first == std::string_view::npos ? std::string_view() : text.substr(first);
}

bool has(std::string_view text, std::string_view word) { return text.find(word) != std::string_view::npos; }

/// Whether one of the lines begins with `word`.
bool line_starts(std::string_view text, std::string_view word) {
  for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
    if (at == 0 || text[at - 1] == '\n' || text[at - 1] == '\r') return true;
  }
  return false;
}

/// Comments may stand before what says the format.
bool is_gmsh(const FileHead& head, const FormatRow& /*row*/) {
  const std::string_view text = text_of(head);
  return text.starts_with("$MeshFormat") ||
         (text.starts_with("$Comments") && line_starts(text, "$MeshFormat"));
}

bool has_ending(const FileHead& head, const FormatRow& row) { return names_ending(row, head.ending); }

/// The value of an attribute of the first start tag `element`, or empty.
std::string_view attribute(std::string_view text, std::string_view element, std::string_view name) {
  const std::size_t start = text.find(element);
  if (start == std::string_view::npos) return {};
  const std::string_view tag = text.substr(start, text.find('>', start) - start);
  const std::string key = " " + std::string(name) + "=";
  const std::size_t at = tag.find(key);
  if (at == std::string_view::npos || at + key.size() >= tag.size()) return {};
  const char quote = tag[at + key.size()];
  if (quote != '"' && quote != '\'') return {};
  const std::size_t first = at + key.size() + 1;
  const std::size_t last = tag.find(quote, first);
  return last == std::string_view::npos ? std::string_view() : tag.substr(first, last - first);
}

bool is_xml(const FileHead& head) { return text_after_blanks(head).starts_with('<'); }
bool is_vtk_xml(const FileHead& head) { return is_xml(head) && has(text_of(head), "<VTKFile"); }
std::string_view vtk_xml_type(const FileHead& head) {
  return is_vtk_xml(head) ? attribute(text_of(head), "<VTKFile", "type") : std::string_view();
}

bool is_grid_type(std::string_view type) {
  static constexpr std::array<std::string_view, 5> kTypes{"ImageData", "RectilinearGrid", "StructuredGrid",
                                                          "UnstructuredGrid", "PolyData"};
  return std::find(kTypes.begin(), kTypes.end(), type) != kTypes.end();
}

bool is_netcdf(std::string_view text) {
  return text.size() >= 4 && text.starts_with("CDF") && (text[3] == 1 || text[3] == 2 || text[3] == 5);
}
bool is_hdf5(std::string_view text) { return text.starts_with("\x89HDF\r\n\x1a\n"); }
bool is_zip(std::string_view text) { return text.starts_with("PK\3\4"); }
/// @}

/// @name Recognisers of single formats, in the order of their rows.
/// @{

bool is_vtk_xml_grid(const FileHead& head, const FormatRow&) { return is_grid_type(vtk_xml_type(head)); }
bool is_vtk_multi_block(const FileHead& head, const FormatRow&) {
  const std::string_view type = vtk_xml_type(head);
  return type == "vtkMultiBlockDataSet" || type == "vtkPartitionedDataSet" || type == "vtkOverlappingAMR" ||
         type == "vtkNonOverlappingAMR" || type == "vtkHierarchicalBoxDataSet";
}
bool is_vtk_parallel(const FileHead& head, const FormatRow&) {
  const std::string_view type = vtk_xml_type(head);
  return type.starts_with('P') && is_grid_type(type.substr(1));
}
bool is_paraview_series(const FileHead& head, const FormatRow&) {
  const std::string_view text = text_after_blanks(head);
  return vtk_xml_type(head) == "Collection" ||
         (text.starts_with('{') && has(text, "\"file-series-version\""));
}

bool is_xdmf(const FileHead& head, const FormatRow&) { return is_xml(head) && has(text_of(head), "<Xdmf"); }
bool is_cgns(const FileHead& head, const FormatRow& row) {
  const std::string_view text = text_of(head);
  if (lowered(text.substr(0, 64)).starts_with("@(#)adf database")) return true;
  return is_hdf5(text) && (has_ending(head, row) || has(text, "CGNSLibraryVersion"));
}
bool is_vtkhdf(const FileHead& head, const FormatRow&) {
  const std::string_view text = text_of(head);
  return is_hdf5(text) && (head.ending == ".vtkhdf" || has(text, "VTKHDF"));
}
/// Cells in lists, as UGRID has them, are no grid.
bool is_ugrid(std::string_view text) { return has(text, "mesh_topology"); }
bool is_netcdf_grid(const FileHead& head, const FormatRow& row) {
  const std::string_view text = text_of(head);
  if (is_ugrid(text)) return false;
  return (is_netcdf(text) && !has(text, "num_nodes")) || (is_hdf5(text) && has_ending(head, row));
}
/// Sections in brackets, the first of them a comment, a header or the number of dimensions.
bool is_fluent(const FileHead& head) {
  const std::string_view text = text_after_blanks(head);
  return text.starts_with("(0 ") || text.starts_with("(1 ") || text.starts_with("(2 ");
}
bool is_fluent_case(const FileHead& head, const FormatRow& row) {
  return is_fluent(head) && has_ending(head, row);
}
bool is_gambit(const FileHead& head, const FormatRow&) {
  return text_after_blanks(head).starts_with("CONTROL INFO");
}
bool is_star_cd(const FileHead& head, const FormatRow&) {
  const std::string start = lowered(text_after_blanks(head).substr(0, 16));
  return start.starts_with("prostar_vertex") || start.starts_with("prostar_cell");
}

/// A netCDF-4 file is HDF5: whether it is Exodus II only its reader can tell, so the ending decides.
bool is_exodus(const FileHead& head, const FormatRow& row) {
  const std::string_view text = text_of(head);
  return (is_netcdf(text) && has(text, "num_nodes")) || (is_hdf5(text) && has_ending(head, row));
}

/// The case file is text with section keywords; FORMAT comes first and GEOMETRY must be there.
bool looks_like_ensight(const FileHead& head, const FormatRow&) {
  const std::string_view text = text_of(head);
  return line_starts(text, "FORMAT") && line_starts(text, "GEOMETRY") && has(text, "type:") &&
         has(text, "ensight");
}

/// Lines of KEY= value; the dimension and the elements are always there.
bool looks_like_su2(const FileHead& head, const FormatRow&) {
  const std::string_view text = text_of(head);
  return line_starts(text, "NDIME") && (line_starts(text, "NELEM") || line_starts(text, "NPOIN"));
}

/// Records of a name at the start of a line, in letters of either size.
bool looks_like_tecplot(const FileHead& head, const FormatRow&) {
  const std::string text = lowered(text_of(head));
  return (line_starts(text, "variables") || has(text, " variables")) &&
         (line_starts(text, "zone") || has(text, " zone")) && has(text, "=") &&
         !has(text, std::string_view("\0", 1));
}

/// The first line that is no comment has five counts.
bool looks_like_ucd(const FileHead& head, const FormatRow& row) {
  if (!has_ending(head, row)) return false;
  std::string_view text = text_after_blanks(head);
  while (text.starts_with('#')) {
    const std::size_t end = text.find('\n');
    text = end == std::string_view::npos ? std::string_view() : trimmed(text.substr(end + 1));
  }
  const auto counts = words(text.substr(0, text.find('\n')));
  return counts.size() == 5 && std::ranges::all_of(counts, [](std::string_view word) {
           return parsed<std::uint32_t>(word).has_value();
         });
}

bool looks_like_openfoam(const FileHead& head, const FormatRow&) {
  return has(text_of(head), "FoamFile") && has(text_of(head), "controlDict");
}
/// A decomposed case may have its mesh, and constant/, in the folders of processors alone.
bool is_openfoam_case(const std::filesystem::path& folder) {
  std::error_code error, ignored;
  if (!std::filesystem::exists(folder / "system/controlDict", ignored)) return false;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if ((name == "constant" || name.starts_with("processor")) && it->is_directory(ignored)) return true;
  }
  return false;
}

/// A zip file one of whose first members is one that every TRX file has.
bool is_trx(const FileHead& head, const FormatRow& row) {
  const std::string_view text = text_of(head);
  return is_zip(text) &&
         (has_ending(head, row) || has(text, "header.json") || has(text, "positions.3.float"));
}
bool is_trx_folder(const std::filesystem::path& folder) {
  static constexpr std::array kPositions{"positions.3.float16", "positions.3.float32", "positions.3.float64"};
  std::error_code ignored;
  if (!std::filesystem::exists(folder / "header.json", ignored)) return false;
  return std::any_of(kPositions.begin(), kPositions.end(),
                     [&](const char* name) { return std::filesystem::exists(folder / name, ignored); });
}

bool is_dicom(const FileHead& head, const FormatRow&) { return is_dicom_start(text_of(head)); }
/// Whether one of the first files of the folder, and of those in it, is DICOM.
bool is_dicom_folder(const std::filesystem::path& folder) {
  constexpr int kMostFiles = 256, kDeepest = 6;
  std::error_code error;
  int files = 0;
  std::filesystem::recursive_directory_iterator it(
      folder, std::filesystem::directory_options::skip_permission_denied, error);
  for (; !error && it != std::filesystem::recursive_directory_iterator() && files < kMostFiles;
       it.increment(error)) {
    if (it.depth() >= kDeepest) it.disable_recursion_pending();
    std::error_code ignored;
    if (!it->is_regular_file(ignored)) continue;
    ++files;
    std::ifstream file(it->path(), std::ios::binary);
    std::array<char, kDicomHeadBytes> head{};
    file.read(head.data(), head.size());
    if (is_dicom_start({head.data(), as_size(file.gcount())})) return true;
  }
  return false;
}

/// The mark stands at the end of the header's 348 bytes, in version 2 behind the size of the header.
bool is_nifti(const FileHead& head, const FormatRow&) {
  constexpr std::size_t kMark1 = 344, kMark2 = 4, kMarkBytes = 4;
  const std::string_view text = text_of(head);
  const auto mark_at = [text](std::size_t at, char version) {
    if (text.size() < at + kMarkBytes) return false;
    const std::string_view mark = text.substr(at, kMarkBytes);
    return mark[0] == 'n' && (mark[1] == '+' || mark[1] == 'i') && mark[2] == version && mark[3] == '\0';
  };
  return mark_at(kMark1, '1') || mark_at(kMark2, '2');
}

/// The header is lines of "key = value", these three among them.
bool is_meta_image(const FileHead& head, const FormatRow&) {
  const std::string_view text = text_of(head);
  return line_starts(text, "NDims") && line_starts(text, "DimSize") && line_starts(text, "ElementType");
}

/// Lines of keywords, some of them indented.
bool looks_like_ex(const FileHead& head, const FormatRow&) {
  const std::string_view text = text_of(head);
  if (!has(text, "#Fields=") && !has(text, "Shape.") && !has(text, "EX Version")) return false;
  return has(text, "Group name:") || has(text, "Region:") || has(text, "EX Version");
}

/// A mesh whose files are bare numbers: the ending says which, the first character that it is text.
bool is_bare_mesh(const FileHead& head, const FormatRow& row) {
  const std::string_view text = text_after_blanks(head);
  if (text.empty() || !has_ending(head, row)) return false;
  return text.front() == '#' || std::isdigit(static_cast<unsigned char>(text.front())) != 0;
}

/// Whether a line of a .dat file is a number, or a node and its time.
bool is_carp_value(std::string_view line, bool table) {
  const std::size_t gap = line.find_first_of(" \t");
  if (!table) return line == "nan" || line == "NaN" || number(line);
  const auto node = number(line.substr(0, gap));
  return gap != std::string_view::npos && node && *node >= 0.0 && *node == std::floor(*node) &&
         number(trimmed(line.substr(gap)));
}

/// Results of openCARP: .igb begins with words as "x:2502 t:101 type:float", .dat holds a number a line, or a
/// node and a time.
bool is_carp_result(const FileHead& head) {
  std::string_view text = text_after_blanks(head);
  if (head.ending == ".igb") {
    const std::string words = lowered(text);
    return has(words, "x:") && has(words, "type:");
  }
  if (head.ending != ".dat") return false;
  constexpr int kLines = 4;  // grids of PLOT3D in text have several numbers on one of them
  bool values = true, table = true;
  for (int line = 0; line < kLines && !text.empty();) {
    const std::string_view here = trimmed(text.substr(0, text.find('\n')));
    if (!here.empty() && !here.starts_with("#")) {
      values = values && is_carp_value(here, false);
      table = table && is_carp_value(here, true);
      ++line;
    }
    const std::size_t end = text.find('\n');
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
  }
  return values || table;
}
/// Surfaces of openCARP's meshes, which are opened with one.
bool is_carp_surface(const FileHead& head) {
  const std::string_view text = text_after_blanks(head);
  return (head.ending == ".surf" || head.ending == ".vtx" || head.ending == ".neubc") && !text.empty() &&
         std::isdigit(static_cast<unsigned char>(text.front())) != 0;
}
bool looks_like_carp(const FileHead& head, const FormatRow& row) {
  return is_bare_mesh(head, row) || is_carp_result(head) || is_carp_surface(head);
}

bool is_plot3d(const FileHead& head, Plot3dFile kind) {
  // Its layout is found from the size of the file: the byte order mark, if there is one, counts.
  const Plot3dBytes bytes{head.bytes, head.tail, head.file_size};
  return find_plot3d_layout(bytes, kind).has_value() || may_be_plot3d_text(bytes, kind);
}
/// ParaView's list of grids and solutions, in JSON.
bool is_plot3d_index(const FileHead& head) {
  return head.ending == ".p3d" && trimmed(text_of(head)).starts_with('{') &&
         has(text_of(head), "\"filenames\"");
}
bool looks_like_plot3d(const FileHead& head, const FormatRow&) {
  return is_plot3d_index(head) || is_plot3d(head, Plot3dFile::kGrid);
}
/// @}

std::string first_bytes(std::string_view bytes) {
  std::string text;
  for (const char c : bytes.substr(0, 16)) {
    const auto b = static_cast<unsigned char>(c);
    if (b >= 0x20 && b < 0x7f) {
      text += c;
    } else {
      std::array<char, 5> hex{};
      std::snprintf(hex.data(), hex.size(), "\\x%02x", b);
      text += hex.data();
    }
  }
  return text;
}

/// The ancestor of NIfTI has the same size of header and no mark.
bool is_analyze(const FileHead& head) {
  const std::string_view text = text_of(head);
  return head.file_size == 348 && (text.starts_with(std::string_view("\x5c\x01\0\0", 4)) ||
                                   text.starts_with(std::string_view("\0\0\x01\x5c", 4)));
}

constexpr const char* kByMeshio = "convert it: 'meshio convert THIS out.vtu'";
constexpr const char* kByParaview = "write it as .vtu or .vtm, in ParaView for one";
constexpr const char* kByLateParaview = "write it as .vtu in ParaView 5.12 or later, which reads UGRID";
constexpr const char* kUgrid = "a netCDF file of a mesh (UGRID)";
constexpr const char* kBySu2 = "add PARAVIEW to OUTPUT_FILES of SU2's configuration, and open the .vtu";

Sniffed hdf5_file(const FileHead& head) {
  const std::string_view text = text_of(head);
  if (is_ugrid(text)) return {{}, kUgrid, kByLateParaview};
  if (head.ending == ".cas.h5" || head.ending == ".dat.h5")
    return {{},
            "a Fluent file in HDF5",
            "write it from Fluent as .cas and .dat without HDF5, or in ParaView as .vtu"};
  if (head.ending == ".silo") return {{}, "a Silo file", "write it as .vtk, in VisIt for one"};
  if (head.ending == ".med") return {{}, "a MED file (in HDF5)", kByMeshio};
  return {{}, "an HDF5 file", "read from HDF5 are Exodus II (.ex2, .exo, .e), CGNS, VTKHDF and netCDF (.nc)"};
}

/// Meshes and results of other programs.
std::optional<Sniffed> known_mesh(const FileHead& head) {
  const std::string_view text = text_of(head), ending = head.ending;
  struct Known {
    std::string_view starts;  ///< without blanks before it, in small letters
    const char* found;
    const char* remedy;
  };
  static constexpr std::array kKnown{
      Known{"#std", "a Nek5000 file", "open the .nek5000 file beside it in ParaView, and write a .vtu"},
      Known{"#!tdv", "a binary Tecplot file", "write it as Tecplot ASCII (.dat)"},
      Known{"#!szplt", "a Tecplot SZL file", "write it as Tecplot ASCII (.dat)"},
      Known{"*heading", "an Abaqus input file", kByMeshio},
      Known{"*node", "an Abaqus input file", kByMeshio},
      Known{"meshversionformatted", "a Medit mesh", kByMeshio},
      Known{"mfem mesh", "an MFEM mesh", "save it by ParaViewDataCollection"},
      Known{"mesh3d", "a Netgen mesh", kByMeshio},
      Known{"$nod", "a Gmsh file of version 1", "write it again: gmsh THIS -save -format msh41"},
      Known{"solid ", "an STL surface", "a flow is in a volume: open the solution"},
      Known{"ply\n", "a PLY surface", "a flow is in a volume: open the solution"},
      Known{"prostar", "a STAR-CD file", "export the solution as EnSight Gold"},
      Known{"\"pointid\"", "a table of SU2's", kBySu2},
      Known{"gid post", "a file of GiD", kByMeshio},
      Known{"begin bulk", "a Nastran file", kByMeshio},
      Known{"nastran", "a Nastran file", kByMeshio}};
  const std::string start = lowered(trimmed(text.substr(0, 256)));
  for (const Known& known : kKnown) {
    if (start.starts_with(known.starts)) return Sniffed{{}, known.found, known.remedy};
  }
  const bool fluent = is_fluent(head);
  if (fluent && ending == ".dat")
    return Sniffed{{}, "the values of a Fluent case", "open its .cas beside it"};
  if (fluent && ending == ".msh")
    return Sniffed{{}, "a Fluent mesh, which holds no flow", "open the .cas of a solution"};
  if (ending == ".nek5000") return Sniffed{{}, "a Nek5000 index", kByParaview};
  if (ending == ".re2")
    return Sniffed{
        {}, "a mesh of Nek5000, which holds no flow", "open the .nek5000 file in ParaView, and write a .vtu"};
  if (ending == ".ugrid") return Sniffed{{}, "an AFLR3 mesh, which holds no flow", "open the solution"};
  if (ending == ".res" && has(text.substr(0, 256), "CFX"))
    return Sniffed{{}, "a result of CFX", "export it as CGNS or EnSight Gold"};
  if (text.starts_with("\x07") && (ending == ".inp" || ending == ".ucd" || ending == ".avs"))
    return Sniffed{{}, "an AVS UCD file in binary", "write it as text, or as .vtu in ParaView"};
  constexpr std::string_view kSu2Mark("\xec\x2b\x08\0", 4);  // 535532
  if (text.starts_with(kSu2Mark)) return Sniffed{{}, "a restart file of SU2", kBySu2};
  if (ending == ".ccm" || ending == ".ccmg" || ending == ".ccmp" || ending == ".ccmt")
    return Sniffed{{}, "a STAR-CCM+ file", "export the solution as EnSight Gold"};
  if (ending == ".bdf" || ending == ".nas") return Sniffed{{}, "a Nastran file", kByMeshio};
  if (ending == ".sim") return Sniffed{{}, "a STAR-CCM+ file", "export the solution as EnSight Gold"};
  if (ending == ".unv") return Sniffed{{}, "an I-DEAS universal file", "convert it to .vtu"};
  if (has(text.substr(0, 256), "C Binary") || start.starts_with("ensight"))
    return Sniffed{{}, "a geometry or variable of EnSight", "open the .case file"};
  return {};
}

/// Known kinds of file that are of none of the formats; nothing where the file is of no such kind.
std::optional<Sniffed> known_other(const FileHead& head) {
  const std::string_view text = text_of(head);
  if (is_zip(text)) return Sniffed{{}, "a zip file without tracts", "unpack it first"};
  if (is_analyze(head))
    return Sniffed{{}, "an Analyze header, which does not say how its axes lie", "convert it to NIfTI"};
  if (is_vtk_xml(head)) {
    const std::string type(vtk_xml_type(head).substr(0, 40));
    if (type.empty())
      return Sniffed{{}, "a VTK XML file whose type is missing or cut off", "it may be truncated"};
    return Sniffed{
        {}, "a VTK XML file of type " + type, "write its pieces as .vti, .vtr, .vts, .vtu or .vtm"};
  }
  if (is_xml(head)) return Sniffed{{}, "an XML file that is not VTK's", ""};
  if (is_netcdf(text)) return Sniffed{{}, kUgrid, kByLateParaview};
  if (is_hdf5(text)) return hdf5_file(head);
  if (auto mesh = known_mesh(head)) return *std::move(mesh);
  if (head.ending == ".toml" && has(text, "format = ") && has(text, "program = "))
    return Sniffed{{}, "a session", "open it with --session THIS"};
  if (head.ending == ".tt")
    return Sniffed{{}, "a tiny-track file of DSI Studio", "save its tracts as .trk.gz or .tck there"};
  if (head.ending == ".fib" || head.ending == ".fz")
    return Sniffed{{}, "a fibre file of DSI Studio", "save its directions as NIfTI there"};
  if (is_gzip(text)) return Sniffed{{}, "a gzip file", "unpack it first"};
  return {};
}

std::optional<Format> find(const FileHead& head, Evidence evidence) {
  for (const FormatRow& row : format_rows()) {
    if (row.evidence == evidence && recognises(row, head)) return row.format;
  }
  return {};
}

}  // namespace

std::span<const FormatRow> format_rows() noexcept {
#define PALPATE_FORMAT(id, ...) FormatRow{.format = Format::id, __VA_ARGS__},
  static constexpr std::array kRows{
#include "common/load/formats.def"
  };
#undef PALPATE_FORMAT
  return kRows;
}

const FormatRow& row_of(Format format) noexcept { return format_rows()[as_size(format)]; }

bool names_ending(const FormatRow& row, std::string_view ending) {
  if (ending.empty()) return false;
  std::string_view rest = row.endings;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, end) == ending) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

bool recognises(const FormatRow& row, const FileHead& head) {
  if (row.recognise != nullptr) return row.recognise(head, row);
  return !row.starts.empty() && text_of(head).starts_with(row.starts);
}

Sniffed sniff(const FileHead& head) {
  if (const auto format = find(head, Evidence::kMark)) return {format, "", ""};
  if (auto other = known_other(head)) return *std::move(other);
  if (const auto format = find(head, Evidence::kWords)) return {format, "", ""};
  if (is_plot3d(head, Plot3dFile::kSolution))
    return {{}, "a PLOT3D solution", "name the grid first: GRID --solution THIS"};
  return {{},
          "not recognised (it starts with \"" + first_bytes(text_of(head)) + "\")",
          "voxels without a header are opened with --raw-size and --raw-type"};
}

}  // namespace palpate
