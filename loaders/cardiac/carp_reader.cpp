#include "loaders/cardiac/carp_reader.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <future>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/math/vec.h"
#include "loaders/cardiac/mesh_text.h"
#include "loaders/cardiac/text_lines.h"

namespace palpate {
namespace {

constexpr double kMillimetres = 1e-3;  // openCARP's unit is the micrometre

struct CellKind {
  std::string_view word;
  std::uint8_t vtk;
  std::size_t corners;
};
constexpr std::array<CellKind, 7> kKinds{{{"Ln", kVtkLine, 2},
                                          {"Tr", kVtkTriangle, 3},
                                          {"Qd", kVtkQuad, 4},
                                          {"Tt", kVtkTetrahedron, 4},
                                          {"Py", kVtkPyramid, 5},
                                          {"Pr", kVtkWedge, 6},
                                          {"Hx", kVtkHexahedron, 8}}};

std::vector<double> read_points(const std::string& file) {
  constexpr std::size_t kLeastBytes = 6;  // "0 0 0\n"
  TextLines lines(file, '#');
  const std::size_t count = believed_count(lines, "the number of points", kLeastBytes);
  std::vector<double> positions;
  for (std::size_t n = 0; n < 3 * count; ++n)
    positions.push_back(lines.number("a coordinate") * kMillimetres);
  return positions;
}

double squared_edges(const std::vector<double>& positions, const std::array<std::int64_t, 8>& cell,
                     std::size_t half) {
  double sum = 0.0;
  for (std::size_t n = 0; n < half; ++n) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double d = positions[static_cast<std::size_t>(cell[n]) * 3 + axis] -
                       positions[static_cast<std::size_t>(cell[n + half]) * 3 + axis];
      sum += d * d;
    }
  }
  return sum;
}

/// Prisms and hexahedra of openCARP run the other way round on their second face than VTK's; some programs
/// write VTK's order. The one whose side edges are shorter is taken.
void order_second_face(const std::vector<double>& positions, std::size_t corners,
                       std::array<std::int64_t, 8>& cell) {
  const std::size_t half = corners / 2;
  std::array<std::int64_t, 8> turned = cell;
  std::reverse(turned.begin() + static_cast<std::ptrdiff_t>(half) + 1,
               turned.begin() + static_cast<std::ptrdiff_t>(corners));
  if (squared_edges(positions, turned, half) < squared_edges(positions, cell, half)) cell = turned;
}

/// @param lines behind the count.
UnstructuredTopology read_elements(TextLines& lines, std::size_t count, const std::vector<double>& positions,
                                   std::vector<double>& regions) {
  const auto last = static_cast<std::int64_t>(positions.size() / 3) - 1;
  UnstructuredTopology topology;
  topology.offsets.push_back(0);
  for (std::size_t e = 0; e < count; ++e) {
    const std::string_view word = lines.word();
    const auto* const kind =
        std::find_if(kKinds.begin(), kKinds.end(), [&](const CellKind& k) { return k.word == word; });
    if (kind == kKinds.end()) {
      if (word.empty()) lines.refuse("ends after " + std::to_string(e) + " elements", std::to_string(count));
      lines.refuse("has an element of type \"" + std::string(word.substr(0, 20)) + "\"",
                   "Tt, Hx, Pr, Py, Qd, Tr or Ln");
    }
    std::array<std::int64_t, 8> cell{};
    for (std::size_t n = 0; n < kind->corners; ++n)
      cell[n] = lines.integer("a point of the element", 0, last);
    if (kind->vtk == kVtkWedge || kind->vtk == kVtkHexahedron)
      order_second_face(positions, kind->corners, cell);
    // Older files have no region.
    const std::string_view region = lines.word_here();
    const auto tag = region.empty() ? std::optional<double>(0.0) : number(region);
    if (!tag) lines.refuse("has \"" + std::string(region.substr(0, 20)) + "\"", "the number of a region");
    regions.push_back(*tag);
    topology.connectivity.insert(topology.connectivity.end(), cell.begin(),
                                 cell.begin() + static_cast<std::ptrdiff_t>(kind->corners));
    topology.types.push_back(kind->vtk);
    topology.offsets.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
  }
  return topology;
}

Directions read_fibres(const std::string& file, std::size_t elements) {
  TextLines lines(file, '#');
  const std::int64_t vectors = lines.integer("1 or 2 directions an element,", 1, 2);
  Directions directions = read_directions(lines, elements, {.numbers = vectors == 2 ? 6 : 3});
  if (!lines.word().empty())
    lines.refuse("goes on after " + std::to_string(elements) + " directions", "one an element");
  return directions;
}

}  // namespace

CarpFiles find_carp_files(const std::vector<std::string>& named) {
  CarpFiles files;
  for (const std::string& file : named) {
    const std::string ending = ending_of(file);
    if (ending == ".igb" || ending == ".dat") {
      files.results.push_back(file);
      continue;
    }
    std::string* part = ending == ".pts" ? &files.pts : ending == ".elem" ? &files.elem : &files.lon;
    if (!part->empty()) throw input_error({file, "", "plays the same part as " + *part, "one of them"});
    *part = file;
  }
  const std::string& any = named.front();
  if (files.pts.empty()) files.pts = sibling(any, ".pts");
  if (files.elem.empty()) files.elem = sibling(any, ".elem");
  if (files.lon.empty()) files.lon = sibling(any, ".lon");
  for (const char* ending : {".igb", ".dat"}) {
    const std::string beside = sibling(any, ending);
    if (!beside.empty() &&
        std::find(files.results.begin(), files.results.end(), beside) == files.results.end())
      files.results.push_back(beside);
  }
  if (files.pts.empty())
    throw input_error({any, "", "has no .pts file beside it", stem_of(any) + ".pts", "name it too"});
  if (files.elem.empty())
    throw input_error({any, "", "has no .elem file beside it", stem_of(any) + ".elem", "name it too"});
  return files;
}

DataSet read_carp(const CarpFiles& files, std::vector<std::string>& notes) {
  constexpr std::size_t kLeastBytes = 7;  // "Ln 0 1\n"
  TextLines lines(files.elem, '#');
  const std::size_t elements = believed_count(lines, "the number of elements", kLeastBytes);
  // The longest of the files is read beside the others.
  std::future<Directions> fibres;
  if (!files.lon.empty()) fibres = std::async(std::launch::async, read_fibres, files.lon, elements);
  const std::vector<double> positions = read_points(files.pts);
  std::vector<double> regions;
  UnstructuredTopology topology = read_elements(lines, elements, positions, regions);
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(positions));
  DataSet mesh;
  mesh.topology = std::move(topology);
  if (!files.lon.empty()) {
    const Directions directions = fibres.get();
    add_directions(directions, mesh);
    if (directions.missing > 0)
      notes.push_back(counted(directions.missing, "element") + " without a fibre direction: no data there");
    notes.push_back("fibres from " + files.lon);
  }
  mesh.arrays.push_back(make_array("region", Association::kCell, 1, std::span<const double>(regions)));
  notes.emplace_back("micrometres of openCARP turned into mm");
  return mesh;
}

}  // namespace palpate
