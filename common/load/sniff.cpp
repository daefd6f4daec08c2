#include "common/load/sniff.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/errno_text.h"
#include "common/base/error.h"
#include "common/base/number_text.h"
#include "common/base/unique_fd.h"
#include "common/load/gzip_head.h"
#include "common/load/plot3d_layout.h"

namespace palpate {
namespace {

constexpr const char* kReadableFolder =
    "a file, or the folder of an OpenFOAM case, of a DICOM series or of TRX tracts";

/// What the points of a TRX folder may be called.
constexpr std::array kPositions{"positions.3.float16", "positions.3.float32", "positions.3.float64"};

constexpr const char* kReadable =
    "a VTK, NRRD, NIfTI, DICOM, MetaImage, MRtrix, OpenVDB, PLOT3D, EnSight, Exodus II, OpenFOAM, EX, "
    "openCARP or "
    "TetGen "
    "file, or "
    "tracts (.tck, .trk, .trx)";

bool starts_with(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

std::string lower_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), lower);
  return ending;
}

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

Sniffed sniff_vtk_xml(std::string_view text) {
  const std::string_view type = attribute(text, "<VTKFile", "type");
  static constexpr std::array<std::string_view, 5> kSingle{"ImageData", "RectilinearGrid", "StructuredGrid",
                                                           "UnstructuredGrid", "PolyData"};
  if (std::find(kSingle.begin(), kSingle.end(), type) != kSingle.end()) return {Format::kVtkXml, "", ""};
  if (type.starts_with('P') && std::find(kSingle.begin(), kSingle.end(), type.substr(1)) != kSingle.end())
    return {Format::kVtkParallel, "", ""};
  if (type == "vtkMultiBlockDataSet" || type == "vtkPartitionedDataSet")
    return {Format::kVtkMultiBlock, "", ""};
  if (type == "Collection") return {Format::kParaviewSeries, "", ""};
  if (type.empty()) return {{}, "a VTK XML file whose type is missing or cut off", "it may be truncated"};
  return {{},
          "a VTK XML file of type " + std::string(type.substr(0, 40)),
          "write its pieces as .vti, .vtr, .vts, .vtu or .vtm"};
}

/// Whether one of the lines begins with `word`.
bool line_starts(std::string_view text, std::string_view word) {
  for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
    if (at == 0 || text[at - 1] == '\n' || text[at - 1] == '\r') return true;
  }
  return false;
}

/// EnSight's case file is text with section keywords; FORMAT comes first and GEOMETRY must be there.
bool looks_like_ensight(std::string_view text) {
  return line_starts(text, "FORMAT") && line_starts(text, "GEOMETRY") &&
         text.find("type:") != std::string_view::npos && text.find("ensight") != std::string_view::npos;
}

/// MetaImage's header is lines of "key = value", these three among them.
bool looks_like_meta_image(std::string_view text) {
  return line_starts(text, "NDims") && line_starts(text, "DimSize") && line_starts(text, "ElementType");
}

/// EX files are lines of keywords, some of them indented.
bool looks_like_ex(std::string_view text) {
  const auto has = [text](std::string_view word) { return text.find(word) != std::string_view::npos; };
  if (!has("#Fields=") && !has("Shape.") && !has("EX Version")) return false;
  return has("Group name:") || has("Region:") || has("EX Version");
}

/// Meshes whose files are bare numbers: the ending says which, the first character that it is text.
std::optional<Format> bare_mesh(std::string_view trimmed, std::string_view ending) {
  static constexpr std::array<std::string_view, 3> kCarp{".pts", ".elem", ".lon"};
  static constexpr std::array<std::string_view, 6> kTetgen{".node",  ".ele", ".face",
                                                           ".ortho", ".axi", ".bases"};
  if (trimmed.empty()) return {};
  const char first = trimmed.front();
  if (first != '#' && std::isdigit(static_cast<unsigned char>(first)) == 0) return {};
  if (std::find(kCarp.begin(), kCarp.end(), ending) != kCarp.end()) return Format::kCarp;
  if (std::find(kTetgen.begin(), kTetgen.end(), ending) != kTetgen.end()) return Format::kTetgen;
  return {};
}

/// Results of openCARP: .igb begins with words as "x:2502 t:101 type:float", .dat holds a number a line.
bool looks_like_carp_result(std::string_view text, std::string_view ending) {
  if (ending == ".igb")
    return text.find("x:") != std::string_view::npos && text.find("type:") != std::string_view::npos;
  if (ending != ".dat") return false;
  constexpr int kLines = 4;  // grids of PLOT3D in text have several numbers on one of them
  for (int line = 0; line < kLines && !text.empty(); ++line) {
    const std::string_view here = trimmed(text.substr(0, text.find('\n')));
    const bool none = here == "nan" || here == "NaN";
    if (!none && !number(here)) return false;
    const std::size_t end = text.find('\n');
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
  }
  return true;
}

/// NIfTI's mark stands at the end of its 348 bytes, in version 2 behind the size of the header.
bool looks_like_nifti(std::string_view text) {
  constexpr std::size_t kMark1 = 344, kMark2 = 4, kMarkBytes = 4;
  const auto has = [text](std::size_t at, char version) {
    if (text.size() < at + kMarkBytes) return false;
    const std::string_view mark = text.substr(at, kMarkBytes);
    return mark[0] == 'n' && (mark[1] == '+' || mark[1] == 'i') && mark[2] == version && mark[3] == '\0';
  };
  return has(kMark1, '1') || has(kMark2, '2');
}

/// DICOM's mark stands behind a preamble of any bytes.
bool looks_like_dicom(std::string_view text) {
  constexpr std::size_t kPreamble = 128;
  return text.size() > kPreamble && text.substr(kPreamble, 4) == "DICM";
}

/// A zip file one of whose first members is one that every TRX file has.
bool looks_like_trx(std::string_view text, std::string_view ending) {
  if (!starts_with(text, "PK\3\4")) return false;
  const auto has = [text](std::string_view name) { return text.find(name) != std::string_view::npos; };
  return ending == ".trx" || has("header.json") || has("positions.3.float");
}

/// The ancestor of NIfTI has the same size of header and no mark.
bool looks_like_analyze(std::string_view text, std::uint64_t file_size) {
  return file_size == 348 && (text.starts_with(std::string_view("\x5c\x01\0\0", 4)) ||
                              text.starts_with(std::string_view("\0\0\x01\x5c", 4)));
}

std::string printable(std::string_view bytes) {
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

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& found,
                         const std::string& expected = "", const std::string& remedy = "") {
  throw input_error({path.string(), "", found, expected, remedy});
}

bool is_openfoam_case(const std::filesystem::path& folder) {
  std::error_code ignored;
  return std::filesystem::exists(folder / "system/controlDict", ignored) &&
         std::filesystem::is_directory(folder / "constant", ignored);
}

bool is_trx_folder(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!std::filesystem::exists(folder / "header.json", ignored)) return false;
  return std::any_of(kPositions.begin(), kPositions.end(),
                     [&](const char* name) { return std::filesystem::exists(folder / name, ignored); });
}

/// Whether one of the first files of the folder is DICOM.
bool is_dicom_folder(const std::filesystem::path& folder) {
  constexpr int kMostFiles = 64;
  constexpr std::size_t kHead = 132;
  std::error_code error;
  int files = 0;
  for (auto it = std::filesystem::directory_iterator(folder, error);
       !error && it != std::filesystem::directory_iterator() && files < kMostFiles; it.increment(error)) {
    std::error_code ignored;
    if (!it->is_regular_file(ignored)) continue;
    ++files;
    std::ifstream file(it->path(), std::ios::binary);
    std::array<char, kHead> head{};
    if (file.read(head.data(), kHead) && looks_like_dicom({head.data(), kHead})) return true;
  }
  return false;
}

}  // namespace

Sniffed sniff(const FileHead& head) {
  std::string_view text(reinterpret_cast<const char*>(head.bytes.data()), head.bytes.size());
  if (starts_with(text, "\xef\xbb\xbf")) text.remove_prefix(3);  // byte order mark of UTF-8
  if (starts_with(text, "# vtk DataFile")) return {Format::kLegacyVtk, "", ""};
  if (starts_with(text, "NRRD000")) return {Format::kNrrd, "", ""};
  if (starts_with(text, std::string_view(" BDV\0\0\0\0", 8))) return {Format::kVdb, "", ""};
  if (starts_with(text, "mrtrix image")) return {Format::kMrtrixImage, "", ""};
  if (starts_with(text, "mrtrix tracks")) return {Format::kTck, "", ""};
  if (starts_with(text, std::string_view("TRACK\0", 6))) return {Format::kTrk, "", ""};
  if (looks_like_trx(text, head.ending)) return {Format::kTrx, "", ""};
  if (starts_with(text, "PK\3\4")) return {{}, "a zip file without tracts", "unpack it first"};
  if (looks_like_dicom(text)) return {Format::kDicom, "", ""};
  if (looks_like_nifti(text)) return {Format::kNifti, "", ""};
  if (looks_like_analyze(text, head.file_size))
    return {{}, "an Analyze header, which does not say how its axes lie", "convert it to NIfTI"};
  if (looks_like_meta_image(text)) return {Format::kMetaImage, "", ""};

  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const std::string_view trimmed = first == std::string_view::npos ? std::string_view() : text.substr(first);
  if (starts_with(trimmed, "<") && trimmed.find("<VTKFile") != std::string_view::npos)
    return sniff_vtk_xml(trimmed);
  if (starts_with(trimmed, "<")) return {{}, "an XML file that is not VTK's", ""};
  if (starts_with(trimmed, "{") && trimmed.find("\"file-series-version\"") != std::string_view::npos) {
    return {Format::kParaviewSeries, "", ""};
  }

  const bool netcdf =
      text.size() >= 4 && starts_with(text, "CDF") && (text[3] == 1 || text[3] == 2 || text[3] == 5);
  if (netcdf) {
    if (text.find("num_nodes") != std::string_view::npos) return {Format::kExodus, "", ""};
    return {{}, "a netCDF file that is not Exodus II (it has no num_nodes)", ""};
  }
  if (starts_with(text, "\x89HDF\r\n\x1a\n")) {
    // A netCDF-4 file is HDF5; whether it is Exodus II only its reader can tell.
    static constexpr std::array<std::string_view, 6> kExodusEndings{".e",    ".ex2", ".exo",
                                                                    ".exii", ".g",   ".gen"};
    if (std::find(kExodusEndings.begin(), kExodusEndings.end(), head.ending) != kExodusEndings.end()) {
      return {Format::kExodus, "", ""};
    }
    return {{}, "an HDF5 file", "only Exodus II (.ex2, .exo, .e) is read from HDF5"};
  }
  if (head.ending == ".toml" && text.find("format = ") != std::string_view::npos &&
      text.find("program = ") != std::string_view::npos) {
    return {{}, "a session", "open it with --session THIS"};
  }
  if (is_gzip(text)) return {{}, "a gzip file", "unpack it first"};
  if (looks_like_ensight(text)) return {Format::kEnsight, "", ""};
  if (text.find("FoamFile") != std::string_view::npos && text.find("controlDict") != std::string_view::npos) {
    return {Format::kOpenFoam, "", ""};
  }
  if (looks_like_ex(text)) return {Format::kEx, "", ""};
  if (const auto mesh = bare_mesh(trimmed, head.ending)) return {mesh, "", ""};
  if (looks_like_carp_result(trimmed, head.ending)) return {Format::kCarp, "", ""};
  const Plot3dBytes bytes{head.bytes, head.tail, head.file_size};
  if (find_plot3d_layout(bytes, Plot3dFile::kGrid) || may_be_plot3d_text(bytes, Plot3dFile::kGrid))
    return {Format::kPlot3d, "", ""};
  if (find_plot3d_layout(bytes, Plot3dFile::kSolution) || may_be_plot3d_text(bytes, Plot3dFile::kSolution)) {
    return {{}, "a PLOT3D solution", "name the grid first: GRID --solution THIS"};
  }
  return {{},
          "not recognised (it starts with \"" + printable(text) + "\")",
          "voxels without a header are opened with grid's --raw-size and --raw-type"};
}

HeadOfFile read_head(const std::filesystem::path& path, std::size_t bytes, std::size_t tail_bytes) {
  // O_NONBLOCK: opening a pipe must not wait for a writer.
  const UniqueFd fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (!fd) {
    if (errno == ENOENT || errno == ENOTDIR) refuse(path, "no such file");
    refuse(path, std::string("cannot be read (") + errno_text() + ")", "", "check its permissions");
  }
  struct stat status {};
  if (::fstat(fd.get(), &status) != 0) refuse(path, std::string("cannot be read (") + errno_text() + ")");
  if (S_ISDIR(status.st_mode)) refuse(path, "is a folder", kReadableFolder);
  if (!S_ISREG(status.st_mode)) refuse(path, "is a pipe or device", "a regular file");

  HeadOfFile head;
  head.file_size = static_cast<std::uint64_t>(status.st_size);
  const auto read_part = [&](std::uint64_t offset, std::uint64_t count) {
    std::string part(count, '\0');
    std::size_t have = 0;
    while (have < part.size()) {
      const ssize_t got =
          ::pread(fd.get(), part.data() + have, part.size() - have, static_cast<off_t>(offset + have));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) refuse(path, std::string("cannot be read (") + errno_text() + ")");
      if (got == 0) break;
      have += static_cast<std::size_t>(got);
    }
    part.resize(have);
    return part;
  };
  head.bytes = read_part(0, std::min<std::uint64_t>(bytes, head.file_size));
  const std::uint64_t tail = std::min<std::uint64_t>(tail_bytes, head.file_size);
  head.tail = read_part(head.file_size - tail, tail);
  return head;
}

Format find_format(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    if (is_openfoam_case(path)) return Format::kOpenFoam;
    if (is_trx_folder(path)) return Format::kTrx;
    if (is_dicom_folder(path)) return Format::kDicom;
    refuse(path, "is a folder", kReadableFolder);
  }
  HeadOfFile head = read_head(path, kSniffBytes, kPlot3dTailBytes);
  std::string ending = lower_ending(path);
  if (ending == ".foam" || ending == ".openfoam") {
    // By custom an empty file that only marks the case's folder.
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    if (is_openfoam_case(folder)) return Format::kOpenFoam;
    refuse(path, "marks no OpenFOAM case", "system/controlDict and constant/ beside it");
  }
  if (head.file_size == 0) refuse(path, "is empty", kReadable);
  const bool packed = is_gzip(head.bytes);
  if (packed) {
    head.bytes = gzip_head(head.bytes, kSniffBytes);
    head.tail.clear();
    if (ending == ".gz") ending = lower_ending(path.stem());
  }
  const Sniffed sniffed = sniff(
      {std::as_bytes(std::span(head.bytes)), std::as_bytes(std::span(head.tail)), head.file_size, ending});
  if (packed && head.bytes.empty())
    refuse(path, "a gzip file of which nothing can be unpacked", "", "it may be cut off or damaged");
  const bool unpacks = sniffed.format == Format::kNifti || sniffed.format == Format::kMrtrixImage ||
                       sniffed.format == Format::kEx || sniffed.format == Format::kCarp ||
                       sniffed.format == Format::kTetgen;
  if (packed && !unpacks) {
    refuse(path,
           "a gzip file" + (sniffed.format ? " of " + std::string(name_of(*sniffed.format)) : std::string()),
           kReadable, "unpack it first");
  }
  if (!sniffed.format) refuse(path, sniffed.found, kReadable, sniffed.remedy);
  return *sniffed.format;
}

}  // namespace palpate
