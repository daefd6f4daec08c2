#include "loaders/cardiac/carp_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <future>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/layer/wall_surfaces.h"
#include "common/load/volume_block.h"
#include "common/math/vec.h"
#include "loaders/cardiac/carp_binary.h"
#include "loaders/cardiac/carp_surfaces.h"
#include "loaders/cardiac/mesh_text.h"
#include "loaders/cardiac/text_lines.h"

namespace palpate {
namespace {

constexpr double kMillimetres = 1e-3;      // openCARP's unit is the micrometre
constexpr std::size_t kMostLabels = 1000;  // that differ

/// @throws Error (bad input) where text follows the `count` rows that the first line promises.
void refuse_more(TextLines& lines, std::size_t count, const std::string& what) {
  if (!lines.word().empty())
    lines.refuse("goes on after " + counted(count, what), "as many as the first line says");
}

std::vector<double> read_points(const std::string& file) {
  constexpr std::size_t kLeastBytes = 6;  // "0 0 0\n"
  TextLines lines(file, '#');
  const std::size_t count = believed_count(lines, "the number of points", kLeastBytes);
  std::vector<double> positions;
  for (std::size_t p = 0; p < count; ++p) {
    // Row by row: numbers too many in one would shift all that follow.
    std::size_t words = 0;
    for (std::string_view word = lines.word(); !word.empty(); word = lines.word_here(), ++words) {
      const auto value = number(word);
      if (!value || !std::isfinite(*value))
        lines.refuse("has \"" + std::string(word.substr(0, 40)) + "\"", "a coordinate");
      if (words < 3) positions.push_back(*value);
    }
    if (words == 0) lines.refuse("ends after " + counted(p, "point"), std::to_string(count));
    if (words != 3) lines.refuse("has " + counted(words, "number"), "x y z of a point");
  }
  refuse_more(lines, count, "point");
  return positions;
}

double squared_edges(const std::vector<double>& positions, const std::array<std::int64_t, 8>& cell,
                     std::size_t half) {
  double sum = 0.0;
  for (std::size_t n = 0; n < half; ++n) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double d = positions[as_size(cell[n]) * 3 + axis] - positions[as_size(cell[n + half]) * 3 + axis];
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

/// @param lines behind the count. @param points of the mesh; one more may be named, where they count from 1.
CarpElements read_elements(TextLines& lines, std::size_t count, std::size_t points) {
  CarpElements elements;
  UnstructuredTopology& topology = elements.topology;
  topology.offsets.push_back(0);
  const auto last = static_cast<std::int64_t>(points) - 1;
  for (std::size_t e = 0; e < count; ++e) {
    const std::string_view word = lines.word();
    const auto* const kind = std::find_if(kCarpCells.begin(), kCarpCells.end(), [&](const CarpCell& cell) {
      return cell.vtk != 0 && cell.word == word;
    });
    if (kind == kCarpCells.end()) {
      if (word.empty()) lines.refuse("ends after " + std::to_string(e) + " elements", std::to_string(count));
      lines.refuse("has an element of type \"" + std::string(word.substr(0, 20)) + "\"",
                   "Tt, Hx, Pr, Py, Qd, Tr or Ln");
    }
    for (std::size_t n = 0; n < kind->corners; ++n) {
      const std::int64_t from_one = elements.lowest > 0 ? 1 : 0;
      const std::int64_t point = lines.integer("a point of the element", 0, last + from_one);
      elements.lowest = std::min(elements.lowest, point);
      elements.highest = std::max(elements.highest, point);
      // One beyond the last may stand in rows that come before the one that names point 0.
      if (elements.lowest == 0 && elements.highest > last)
        lines.refuse("names point 0, and the file point " + std::to_string(elements.highest),
                     "points from 0 to " + std::to_string(last) + ", or from 1");
      topology.connectivity.push_back(point);
    }
    // Older files have no region; some programs put its name behind it.
    double region = 0.0;
    bool first = true;
    for (std::string_view more = lines.word_here(); !more.empty(); more = lines.word_here(), first = false) {
      const auto tag = number(more);
      if (first && tag) {
        region = *tag;
      } else if (elements.labels.size() < kMostLabels || elements.labels.contains(more)) {
        ++elements.labels[std::string(more.substr(0, 40))];
      }
    }
    elements.regions.push_back(region);
    topology.types.push_back(kind->vtk);
    topology.offsets.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
  }
  refuse_more(lines, count, "element");
  return elements;
}

/// Sum of the squared edges between all corners of a cell that follow one another in its row, where points
/// count from `first`.
double squared_steps(const UnstructuredTopology& topology, const std::vector<double>& positions,
                     std::int64_t first) {
  double sum = 0.0;
  for (std::size_t c = 0; c < topology.types.size(); ++c) {
    for (std::int64_t n = topology.offsets[c] + 1; n < topology.offsets[c + 1]; ++n) {
      const std::int64_t a = topology.connectivity[as_size(n) - 1] - first;
      const std::int64_t b = topology.connectivity[as_size(n)] - first;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double d = positions[3 * as_size(a) + axis] - positions[3 * as_size(b) + axis];
        sum += d * d;
      }
    }
  }
  return sum;
}

/// Whether the elements count points from 1: they name the point behind the last, or, where no element names
/// point 0, their edges are much shorter so.
/// @return the number of the first point.
std::int64_t count_from_zero(const std::string& file, const std::vector<double>& positions,
                             CarpElements& elements, std::vector<std::string>& notes) {
  constexpr double kMuchShorter = 0.8;  // of the squares; a mesh whose points are off by one has long edges
  if (elements.lowest < 1 || elements.topology.types.empty()) return 0;
  const auto points = static_cast<std::int64_t>(positions.size() / 3);
  std::string why = "an element names point " + std::to_string(points) + " of " + std::to_string(points);
  if (elements.highest < points) {
    const double from_zero = squared_steps(elements.topology, positions, 0);
    const double from_one = squared_steps(elements.topology, positions, 1);
    if (!(from_one < kMuchShorter * from_zero)) {
      if (!(from_zero < kMuchShorter * from_one))
        notes.push_back("WARNING: no element of " + file +
                        " names point 0, and edges do not tell whether points count from 0 or 1: taken as "
                        "from 0");
      return 0;
    }
    why = "no element names point 0, and edges are " +
          short_number(std::round(100.0 * std::sqrt(from_one / from_zero))) + " % as long so";
  }
  for (std::int64_t& point : elements.topology.connectivity) --point;
  notes.push_back("points of " + file + " count from 1: " + why);
  return 1;
}

/// Prisms and hexahedra, see order_second_face().
void order_second_faces(const std::vector<double>& positions, UnstructuredTopology& topology) {
  for (std::size_t c = 0; c < topology.types.size(); ++c) {
    if (topology.types[c] != kVtkWedge && topology.types[c] != kVtkHexahedron) continue;
    const auto begin = topology.connectivity.begin() + topology.offsets[c];
    const std::size_t corners = as_size(topology.offsets[c + 1] - topology.offsets[c]);
    std::array<std::int64_t, 8> cell{};
    std::copy_n(begin, corners, cell.begin());
    order_second_face(positions, corners, cell);
    std::copy_n(cell.begin(), corners, begin);
  }
}

void note_labels(const std::string& file, const CarpElements& elements, std::vector<std::string>& notes) {
  if (elements.labels.empty()) return;
  std::string names;
  std::size_t rows = 0, named = 0;
  for (const auto& [label, count] : elements.labels) {
    rows += count;
    constexpr std::size_t kNamed = 5;
    if (++named <= kNamed) (names += names.empty() ? "" : ", ") += label;
    if (named == kNamed + 1) names += ", …";
  }
  notes.push_back(counted(rows, "word") + " behind the regions of " + file + " left out: " + names);
}

/// Directions and whether the file begins with them, without a header.
struct Fibres {
  Directions directions;
  int vectors = 0;
  bool headed = true;
};

Fibres read_fibres(const std::string& file, std::size_t elements) {
  Fibres fibres;
  if (is_binary_carp(file)) {
    fibres.directions = read_binary_directions(file, elements);
    return fibres;
  }
  TextLines lines(file, '#');
  do {
    if (!lines.next()) lines.refuse("holds no direction", "1 or 2 directions an element");
  } while (lines.line().empty());
  int words = 0;
  while (!lines.word_here().empty()) ++words;
  lines.give_back();
  (void)lines.next();
  fibres.headed = words != 3 && words != 6 && words != 9;
  fibres.vectors =
      fibres.headed ? static_cast<int>(lines.integer("1 or 2 directions an element,", 1, 2)) : words / 3;
  fibres.directions = read_directions(lines, elements, {.numbers = 3 * fibres.vectors});
  if (!lines.word().empty())
    lines.refuse("goes on after " + std::to_string(elements) + " directions", "one an element");
  return fibres;
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
    if (is_carp_surface(ending)) {
      files.surfaces.push_back(file);
      continue;
    }
    std::string* part = ending.ends_with("pts")    ? &files.pts
                        : ending.ends_with("elem") ? &files.elem
                                                   : &files.lon;
    if (!part->empty()) throw input_error({file, "", "plays the same part as " + *part, "one of them"});
    *part = file;
  }
  const std::string& any = named.front();
  // A mesh may lie there in text and in numbers: parts of one kind belong together.
  const bool binary = std::any_of(named.begin(), named.end(), is_binary_carp);
  const auto find = [&](std::string& part, const std::string& ending) {
    if (part.empty()) part = sibling(any, (binary ? ".b" : ".") + ending);
    if (part.empty()) part = sibling(any, (binary ? "." : ".b") + ending);
  };
  find(files.pts, "pts");
  find(files.elem, "elem");
  find(files.lon, "lon");
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
  // A result that is called so names them itself.
  const bool named_there =
      std::any_of(files.results.begin(), files.results.end(), [](const std::string& result) {
        const std::string name = std::filesystem::path(stem_of(result)).filename().string();
        return name == kSurfaceArray || name.ends_with(std::string(".") + kSurfaceArray);
      });
  if (files.surfaces.empty() && !named_there) files.surfaces = surfaces_beside(stem_of(files.pts));
  return files;
}

DataSet read_carp(const CarpFiles& files, std::vector<std::string>& notes) {
  constexpr std::size_t kLeastBytes = 7;  // "Ln 0 1\n"
  const bool binary = is_binary_carp(files.elem);
  std::optional<TextLines> lines;
  if (!binary) lines.emplace(files.elem, '#');
  const std::size_t count = binary ? count_binary_elements(files.elem)
                                   : believed_count(*lines, "the number of elements", kLeastBytes);
  // The longest of the files is read beside the others.
  std::future<Fibres> fibres;
  if (!files.lon.empty()) fibres = std::async(std::launch::async, read_fibres, files.lon, count);
  std::vector<double> positions =
      is_binary_carp(files.pts) ? read_binary_points(files.pts) : read_points(files.pts);
  for (double& x : positions) x *= kMillimetres;
  const std::size_t points = positions.size() / 3;
  CarpElements read =
      binary ? read_binary_elements(files.elem, points) : read_elements(*lines, count, points);
  const std::int64_t first = count_from_zero(files.elem, positions, read, notes);
  order_second_faces(positions, read.topology);
  note_labels(files.elem, read, notes);
  const std::vector<double>& regions = read.regions;
  read.topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(positions));
  DataSet mesh;
  mesh.topology = std::move(read.topology);
  if (!files.lon.empty()) {
    auto [directions, vectors, headed] = fibres.get();
    if (directions.missing == count) {
      notes.push_back(files.lon + " holds no direction but zeros: taken as a mesh without fibres");
    } else {
      leave_out_missing(directions, notes);
      add_directions(directions, mesh);
      notes.push_back("fibres from " + files.lon);
    }
    if (!headed)
      notes.push_back(files.lon + " has no header: " + std::to_string(3 * vectors) + " numbers a row are " +
                      counted(static_cast<std::uint64_t>(vectors), "direction") + " an element");
  }
  mesh.arrays.push_back(make_array("region", Association::kCell, 1, std::span<const double>(regions)));
  if (!files.surfaces.empty()) add_carp_surfaces(files.surfaces, stem_of(files.pts), first, mesh, notes);
  notes.emplace_back("micrometres of openCARP turned into mm");
  // A heart of a mouse is 5 mm long, and one that is stated in mm would be a thousandth of its size.
  constexpr double kTooSmall = 0.5;  // mm
  constexpr double kTooLarge = 5e3;  // mm; a torso fits in
  const double size = describe_mesh(mesh).bounds.diagonal();
  if (size < kTooSmall)
    notes.push_back("WARNING: the mesh is " + short_number(1e3 * size) +
                    " micrometres across: no heart is; are its points stated in mm?");
  if (size > kTooLarge)
    notes.push_back("WARNING: the mesh is " + short_number(1e-3 * size) +
                    " metres across: no heart is; are its points stated in nanometres?");
  return mesh;
}

}  // namespace palpate
