#include "common/load/write/write_carp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/base/error.h"
#include "common/base/files/kept_files.h"
#include "common/base/files/output_file.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/math/vec_text.h"

namespace palpate {
namespace {

constexpr std::size_t kIgbHeader = 1024;
constexpr double kUneven = 1e-3;
constexpr std::array<const char*, 3> kMeshEndings{".pts", ".elem", ".lon"};

/// A kind of cell as .elem and as VTK name it.
struct CellWord {
  std::uint8_t vtk;
  std::string_view word;
};
constexpr std::uint8_t kVtkTetrahedron = 10, kVtkHexahedron = 12, kVtkWedge = 13;
constexpr std::array<CellWord, 7> kWords{{{3, "Ln"},
                                          {5, "Tr"},
                                          {9, "Qd"},
                                          {kVtkTetrahedron, "Tt"},
                                          {14, "Py"},
                                          {kVtkWedge, "Pr"},
                                          {kVtkHexahedron, "Hx"}}};

const CellWord* word_of(std::uint8_t type) {
  const auto* const found =
      std::find_if(kWords.begin(), kWords.end(), [type](const CellWord& word) { return word.vtk == type; });
  return found == kWords.end() ? nullptr : found;
}

}  // namespace

IgbTimes igb_times(const std::vector<double>& times, const std::string& file) {
  if (times.size() < 2) return {times.empty() ? 0.0 : times.front(), 1.0, 1};
  const IgbTimes even{times.front(), (times.back() - times.front()) / static_cast<double>(times.size() - 1),
                      times.size()};
  for (std::size_t t = 1; t < times.size(); ++t)
    if (!(std::abs(times[t] - times[t - 1] - even.apart) <= kUneven * even.apart))
      throw input_error(
          {file, "times",
           "are not evenly apart (" + short_number(times[t - 1]) + ", then " + short_number(times[t]) + ")",
           "even ones, which are all that .igb can state", "write it as .pvd"});
  return even;
}

/// The files at work.
class CarpOutput::Files {
 public:
  explicit Files(bool overwrite) : overwrite_(overwrite) {}
  OutputFile& open(const std::filesystem::path& path) {
    return *files_.emplace_back(std::make_unique<OutputFile>(path, overwrite_));
  }
  OutputFile& at(std::size_t file) { return *files_[file]; }
  void finish() {
    for (const auto& file : files_) file->finish();
  }
  std::size_t count() const { return files_.size(); }

 private:
  bool overwrite_;
  std::vector<std::unique_ptr<OutputFile>> files_;
};

bool all_in_carp(const UnstructuredTopology& cells) {
  return std::all_of(cells.types.begin(), cells.types.end(),
                     [](std::uint8_t type) { return word_of(type) != nullptr; });
}

UnstructuredTopology cells_of(std::span<const Vec3> points, std::span<const TetMesh::Tet> tets) {
  std::vector<double> positions;
  positions.reserve(3 * points.size());
  for (const Vec3& x : points) positions.insert(positions.end(), {x.x, x.y, x.z});
  UnstructuredTopology cells;
  cells.positions = make_array("points", Association::kPoint, 3, std::span<const double>(positions));
  cells.types.assign(tets.size(), kVtkTetrahedron);
  cells.offsets.push_back(0);
  for (const TetMesh::Tet& tet : tets) {
    cells.connectivity.insert(cells.connectivity.end(), tet.begin(), tet.end());
    cells.offsets.push_back(static_cast<std::int64_t>(cells.connectivity.size()));
  }
  return cells;
}

void keep_carp_inputs(std::span<const std::filesystem::path> files) {
  std::vector<std::filesystem::path> parts;
  for (std::filesystem::path file : files) {
    if (file.extension() == ".gz") file.replace_extension();
    const std::string own = file.extension().string();
    const bool binary = own.starts_with(".b");
    static constexpr std::array<const char*, 8> kOwn{".pts",   ".elem", ".lon", ".bpts",
                                                     ".belem", ".blon", ".igb", ".dat"};
    if (std::find(kOwn.begin(), kOwn.end(), own) == kOwn.end()) continue;
    for (const std::string ending : kMeshEndings) {
      // A text file beside its binary twin is not what is read.
      std::error_code ignored;
      std::filesystem::path twin = file;
      if (binary && std::filesystem::exists(twin.replace_extension(".b" + ending.substr(1)), ignored))
        continue;
      parts.push_back(file.replace_extension(ending));
    }
  }
  keep_from_outputs(parts);
}

CarpRegions carp_regions(std::span<const double> values, const std::string& name) {
  CarpRegions regions;
  const auto whole = [](double value) {
    return value == std::floor(value) && value >= std::numeric_limits<int>::min() &&
           value <= std::numeric_limits<int>::max();
  };
  std::map<double, int> number_of;  // by rising value, where they cannot stay
  std::size_t undefined = 0;
  for (const double value : values) {
    if (std::isfinite(value))
      number_of.emplace(value, 0);
    else
      ++undefined;
  }
  const bool stay =
      std::all_of(number_of.begin(), number_of.end(), [&](const auto& each) { return whole(each.first); });
  int next = 0;
  std::string list;
  for (auto& [value, number] : number_of) {
    number = stay ? static_cast<int>(value) : ++next;
    constexpr int kListed = 8;
    if (!stay && next <= kListed)
      list += (list.empty() ? "" : ", ") + std::to_string(number) + " for " + exact_number(value);
    if (!stay && next == kListed + 1) list += ", …";
  }
  for (const double value : values) regions.numbers.push_back(std::isfinite(value) ? number_of.at(value) : 0);
  if (!stay) regions.note = "regions of '" + name + "' are no whole numbers of .elem: numbered " + list;
  if (undefined > 0)
    regions.note += (regions.note.empty() ? "" : "; ") + counted(undefined, "element") + " of no region: 0";
  return regions;
}

CarpOutput::CarpOutput(std::filesystem::path pts, bool overwrite, bool directions)
    : pts_(std::move(pts)), files_(std::make_unique<Files>(overwrite)) {
  for (const char* ending : kMeshEndings) {
    const std::filesystem::path path = std::filesystem::path(pts_).replace_extension(ending);
    if (!directions && path.extension() == ".lon") {
      std::error_code ignored;
      if (std::filesystem::exists(path, ignored))
        throw usage_error(path.string() +
                          " is there, and would be taken for the fibres of a mesh without any: "
                          "remove it, or write under another name");
      continue;
    }
    names_.push_back(path);
    (void)files_->open(names_.back());
  }
}

CarpOutput::~CarpOutput() = default;

void CarpOutput::write_mesh(const UnstructuredTopology& mesh, double micrometres,
                            std::span<const int> regions) {
  OutputFile& pts = files_->at(0);
  pts.write(std::to_string(mesh.positions.tuples) + "\n");
  for (std::size_t p = 0; p < mesh.positions.tuples; ++p)
    pts.write(exact_row(micrometres *
                        Vec3{mesh.positions.at(p, 0), mesh.positions.at(p, 1), mesh.positions.at(p, 2)}) +
              "\n");
  OutputFile& elem = files_->at(1);
  elem.write(std::to_string(mesh.types.size()) + "\n");
  for (std::size_t c = 0; c < mesh.types.size(); ++c) {
    std::vector<std::int64_t> points(mesh.connectivity.begin() + mesh.offsets[c],
                                     mesh.connectivity.begin() + mesh.offsets[c + 1]);
    // The second face of prisms and hexahedra runs the other way round than VTK's.
    if (mesh.types[c] == kVtkWedge || mesh.types[c] == kVtkHexahedron)
      std::reverse(points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2) + 1, points.end());
    std::string row(word_of(mesh.types[c])->word);
    for (const std::int64_t p : points) row += " " + std::to_string(p);
    elem.write(row + " " + std::to_string(regions.empty() ? 1 : regions[c]) + "\n");
  }
}

void CarpOutput::write_directions(std::span<const Vec3> fibres, std::span<const Vec3> sheets) {
  OutputFile& lon = files_->at(2);
  lon.write(sheets.empty() ? "1\n" : "2\n");
  for (std::size_t c = 0; c < fibres.size(); ++c)
    lon.write(exact_row(unit_or_zero(fibres[c])) +
              (sheets.empty() ? "" : " " + exact_row(unit_or_zero(sheets[c]))) + "\n");
}

std::filesystem::path CarpOutput::result(const std::string& name, const char* ending) const {
  std::string safe = name;
  for (char& c : safe)
    if (c == '/' || c == '\\' || static_cast<unsigned char>(c) <= ' ') c = '_';
  const std::string start = pts_.stem().string() + "." + safe;
  std::filesystem::path path = pts_.parent_path() / (start + ending);
  for (int n = 2; std::find(names_.begin(), names_.end(), path) != names_.end(); ++n)
    path = pts_.parent_path() / (start + "_" + std::to_string(n) + ending);
  return path;
}

void CarpOutput::write_values(const std::string& name, std::span<const double> values) {
  names_.push_back(result(name, ".dat"));
  OutputFile& file = files_->open(names_.back());
  for (const double value : values) file.write((std::isnan(value) ? "nan" : exact_number(value)) + "\n");
}

std::size_t CarpOutput::begin_series(const std::string& name, std::size_t tuples, int components,
                                     const IgbTimes& times, const std::string& unit) {
  constexpr std::array<const char*, 4> kTypes{"float", "complex", "vec3f", "vec4f"};
  names_.push_back(result(name, ".igb"));
  OutputFile& file = files_->open(names_.back());
  const auto steps = static_cast<double>(times.count);
  std::string header = "x:" + std::to_string(tuples) + " y:1 z:1 t:" + std::to_string(times.count) +
                       " type:" + kTypes.at(as_size(components - 1)) +
                       " systeme:little_endian org_t:" + exact_number(times.first) +
                       " dim_t:" + exact_number((steps - 1.0) * times.apart) +
                       " inc_t:" + exact_number(times.apart) + " facteur:1 zero:0" +
                       (times.unit.empty() ? "" : " unites_t:" + times.unit) +
                       (unit.empty() ? "" : " unites:" + unit) + "\r\n";
  header.resize(kIgbHeader - 1, ' ');
  file.write(header + "\f");
  return files_->count() - 1;
}

void CarpOutput::write_step(std::size_t series, std::span<const double> values) {
  for (const double value : values) files_->at(series).write_number(static_cast<float>(value));
}

void CarpOutput::finish() { files_->finish(); }

}  // namespace palpate
