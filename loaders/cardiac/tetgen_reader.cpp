#include "loaders/cardiac/tetgen_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/math/vec.h"
#include "loaders/cardiac/chaste_binary.h"
#include "loaders/cardiac/element_frames.h"
#include "loaders/cardiac/marked_faces.h"
#include "loaders/cardiac/mesh_text.h"
#include "loaders/cardiac/text_lines.h"

namespace palpate {
namespace {

constexpr std::int64_t kMostAttributes = 100;
constexpr std::int64_t kMostPlaces = 1000;        // in an element, where directions are given
constexpr std::string_view kQuadratic = "_quad";  // what Chaste puts behind the name of a quadratic mesh
/// The edges of a tetrahedron in VTK's order of the nodes that halve them.
constexpr std::array<std::pair<std::size_t, std::size_t>, 6> kEdges{
    {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};

struct Nodes {
  std::int64_t first = 0;
  std::vector<double> positions;
  std::vector<std::vector<double>> attributes;
  [[nodiscard]] std::size_t count() const { return positions.size() / 3; }
  [[nodiscard]] Vec3 at(std::int64_t node) const {
    const auto p = as_size(node) * 3;
    return {positions[p], positions[p + 1], positions[p + 2]};
  }
};

/// Numbers that rows have beyond those that the first line of the file says.
class LongerRows {
 public:
  /// What is left of the current row.
  void pass_over(TextLines& lines) {
    std::size_t more = 0;
    while (!lines.word_here().empty()) ++more;
    rows_ += more > 0 ? 1 : 0;
    most_ = std::max(most_, more);
  }
  /// @param what the rows are of: "node".
  void say(const std::string& file, const char* what, std::vector<std::string>& notes) const {
    if (rows_ == 0) return;
    notes.push_back(counted(rows_, "row") + " of " + file + " with up to " + counted(most_, "number") +
                    " more than its first line says of a " + what + ": left out");
  }

 private:
  std::size_t rows_ = 0, most_ = 0;
};

Nodes read_binary_nodes(ChasteBinary& in) {
  if (in.count(1) != 3) in.refuse("has nodes of " + counted(in.count(1), "dimension"), "3");
  const std::uint64_t attributes = in.count(2);
  if (attributes > as_size(kMostAttributes))
    in.refuse("has " + counted(attributes, "attribute"), "at most 100");
  in.read(0, 3 + attributes);
  Nodes nodes;
  nodes.attributes.resize(attributes);
  for (std::size_t n = 0; n < in.count(0); ++n) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      nodes.positions.push_back(in.number(n, axis));
      if (!std::isfinite(nodes.positions.back()))
        in.refuse("has a node " + std::to_string(n) + " whose coordinates are not finite", "numbers");
    }
    for (std::size_t a = 0; a < attributes; ++a) nodes.attributes[a].push_back(in.number(n, 3 + a));
  }
  return nodes;
}

Nodes read_nodes(const std::string& file, std::vector<std::string>& notes) {
  if (auto binary = ChasteBinary::open(file)) return read_binary_nodes(*binary);
  constexpr std::size_t kLeastBytes = 8;  // "0 1 2 3\n"
  TextLines lines(file, '#');
  const std::size_t count = believed_count(lines, "the number of nodes", kLeastBytes);
  (void)lines.integer("the number of dimensions, 3,", 3, 3);
  const auto attributes = as_size(lines.integer("the number of attributes", 0, kMostAttributes));
  const bool marked = lines.integer("0 or 1 for boundary markers,", 0, 1) == 1;
  Nodes nodes;
  nodes.attributes.resize(attributes);
  LongerRows longer;
  std::size_t unmarked = 0;
  for (std::size_t n = 0; n < count; ++n) {
    if (n == 0) {
      nodes.first = lines.integer("0 or 1, the number of the first node,", 0, 1);
    } else {
      const std::int64_t expected = nodes.first + static_cast<std::int64_t>(n);
      (void)lines.integer("the next node's number", expected, expected);
    }
    for (int axis = 0; axis < 3; ++axis) nodes.positions.push_back(lines.number("a coordinate"));
    for (auto& values : nodes.attributes) values.push_back(lines.number("an attribute"));
    if (marked && lines.word_here().empty()) ++unmarked;
    longer.pass_over(lines);
  }
  longer.say(file, "node", notes);
  if (unmarked > 0)
    notes.push_back(counted(unmarked, "node") + " of " + file +
                    " without the boundary marker that its first line says: markers are not needed");
  return nodes;
}

/// Puts the six nodes behind the corners into VTK's order, each to the edge whose middle it is next to.
/// False where two of them are next to one middle.
bool order_mid_nodes(const Nodes& nodes, std::array<std::int64_t, 10>& cell) {
  std::array<std::int64_t, 6> ordered{};
  std::array<bool, 6> taken{};
  for (std::size_t m = 4; m < cell.size(); ++m) {
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t e = 0; e < kEdges.size(); ++e) {
      const Vec3 middle = 0.5 * (nodes.at(cell[kEdges[e].first]) + nodes.at(cell[kEdges[e].second]));
      const double distance = glm::distance(middle, nodes.at(cell[m]));
      if (distance < least) {
        least = distance;
        nearest = e;
      }
    }
    if (taken[nearest]) return false;
    taken[nearest] = true;
    ordered[nearest] = cell[m];
  }
  std::copy(ordered.begin(), ordered.end(), cell.begin() + 4);
  return true;
}

void add_cell(std::span<const std::int64_t> cell, UnstructuredTopology& topology) {
  topology.connectivity.insert(topology.connectivity.end(), cell.begin(), cell.end());
  topology.types.push_back(cell.size() == 10 ? kVtkQuadraticTetrahedron : kVtkTetrahedron);
  topology.offsets.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
}

UnstructuredTopology read_binary_elements(ChasteBinary& in, const Nodes& nodes,
                                          std::vector<std::vector<double>>& attributes) {
  const std::uint64_t corners = in.count(1);
  if (corners != 4 && corners != 10) in.refuse("has elements of " + counted(corners, "node"), "4 or 10");
  if (in.count(2) > as_size(kMostAttributes))
    in.refuse("has " + counted(in.count(2), "attribute"), "at most 100");
  attributes.resize(in.count(2));
  in.read(corners, attributes.size());
  UnstructuredTopology topology;
  topology.offsets.push_back(0);
  for (std::size_t e = 0; e < in.count(0); ++e) {
    std::array<std::int64_t, 10> cell{};
    for (std::size_t n = 0; n < corners; ++n) {
      cell[n] = in.node(e, n);
      if (as_size(cell[n]) >= nodes.count())
        in.refuse("has an element " + std::to_string(e) + " of node " + std::to_string(cell[n]),
                  "nodes from 0 to " + std::to_string(nodes.count()) + " less one");
    }
    for (std::size_t a = 0; a < attributes.size(); ++a) attributes[a].push_back(in.number(e, a));
    if (corners == 10 && !order_mid_nodes(nodes, cell))
      in.refuse("has an element " + std::to_string(e) + " of nodes that are not on its six edges",
                "one node on each edge");
    add_cell(std::span(cell).first(corners), topology);
  }
  return topology;
}

UnstructuredTopology read_elements(const std::string& file, const Nodes& nodes,
                                   std::vector<std::vector<double>>& attributes,
                                   std::vector<std::string>& notes) {
  if (auto binary = ChasteBinary::open(file)) return read_binary_elements(*binary, nodes, attributes);
  constexpr std::size_t kLeastBytes = 10;  // "0 1 2 3 4\n"
  TextLines lines(file, '#');
  const std::size_t count = believed_count(lines, "the number of elements", kLeastBytes);
  const std::int64_t corners = lines.integer("4 or 10 nodes an element,", 4, 10);
  if (corners != 4 && corners != 10)
    lines.refuse("has elements of " + std::to_string(corners) + " nodes", "4 or 10");
  attributes.resize(as_size(lines.integer("the number of attributes", 0, kMostAttributes)));
  UnstructuredTopology topology;
  topology.offsets.push_back(0);
  std::int64_t first = 0;
  LongerRows longer;
  for (std::size_t e = 0; e < count; ++e) {
    const std::int64_t expected = first + static_cast<std::int64_t>(e);
    if (e == 0) {
      first = lines.integer("0 or 1, the number of the first element,", 0, 1);
    } else {
      (void)lines.integer("the next element's number", expected, expected);
    }
    std::array<std::int64_t, 10> cell{};
    const auto used = as_size(corners);
    const std::int64_t last = nodes.first + static_cast<std::int64_t>(nodes.count()) - 1;
    for (std::size_t n = 0; n < used; ++n)
      cell[n] = lines.integer("a node of the element", nodes.first, last) - nodes.first;
    for (auto& values : attributes) values.push_back(lines.number("an attribute"));
    longer.pass_over(lines);
    if (used == 10 && !order_mid_nodes(nodes, cell))
      lines.refuse("has nodes that are not on six edges of their tetrahedron", "one node on each edge");
    add_cell(std::span(cell).first(used), topology);
  }
  longer.say(file, "element", notes);
  return topology;
}

/// Of .ortho, .axi and .bases in text. @param rows gets the number of places in an element.
Directions read_direction_file(const std::string& file, std::size_t elements, DirectionRows& rows) {
  TextLines lines(file, '#');
  const auto count = as_size(lines.integer("the number of directions", 0, 2'000'000'000));
  if (count != elements)
    lines.refuse("has " + std::to_string(count) + " directions",
                 std::to_string(elements) + ", one an element");
  if (rows.numbered)
    rows.places = static_cast<int>(lines.integer("the number of places in an element", 1, kMostPlaces));
  Directions directions = read_directions(lines, count, rows);
  if (!lines.word().empty())
    lines.refuse("goes on after " + std::to_string(count) + " directions", "one an element");
  return directions;
}

/// Of .ortho and .axi, in numbers.
Directions read_binary_directions(ChasteBinary& in, std::size_t elements, std::size_t numbers) {
  if (in.count(0) != elements)
    in.refuse("has " + counted(in.count(0), "direction"), std::to_string(elements) + ", one an element");
  in.read(0, numbers);
  Directions directions;
  for (std::size_t e = 0; e < elements; ++e) {
    std::array<Vec3, 3> row{Vec3{0.0}, Vec3{0.0}, Vec3{0.0}};
    for (std::size_t n = 0; n < numbers; ++n) row[n / 3][static_cast<int>(n % 3)] = in.number(e, n);
    append_directions(std::span(row).first(numbers / 3), directions);
  }
  return directions;
}

/// Whole numbers in the first attribute of elements are the regions: TetGen's, and Chaste's of tissue and bath.
void add_attributes(const std::vector<std::vector<double>>& attributes, Association association,
                    DataSet& mesh) {
  for (std::size_t a = 0; a < attributes.size(); ++a) {
    const bool region = a == 0 && association == Association::kCell &&
                        std::ranges::all_of(attributes[a], [](double v) { return v == std::floor(v); });
    mesh.arrays.push_back(make_array(region ? "region" : "attribute " + std::to_string(a + 1), association, 1,
                                     std::span<const double>(attributes[a])));
  }
}

}  // namespace

TetgenFiles find_tetgen_files(const std::vector<std::string>& named) {
  TetgenFiles files;
  for (const std::string& file : named) {
    const std::string ending = ending_of(file);
    std::string* part = ending == ".node"   ? &files.node
                        : ending == ".ele"  ? &files.ele
                        : ending == ".face" ? &files.face
                                            : &files.directions;
    if (!part->empty()) throw input_error({file, "", "plays the same part as " + *part, "one of them"});
    *part = file;
  }
  const std::string& any = named.front();
  // Chaste keeps directions of a quadratic mesh under the name of the linear one.
  const std::array<std::string, 2> stems{stem_of(any), stem_of(any) + std::string(kQuadratic)};
  for (const std::string& stem : stems) {
    if (files.node.empty()) files.node = sibling(stem + ".ele", ".node");
    if (files.ele.empty()) files.ele = sibling(stem + ".ele", ".ele");
    if (files.face.empty()) files.face = sibling(stem + ".ele", ".face");
  }
  if (files.node.empty())
    throw input_error({any, "", "has no .node file beside it", stem_of(any) + ".node", "name it too"});
  if (files.ele.empty())
    throw input_error({any, "", "has no .ele file beside it", stem_of(any) + ".ele", "name it too"});
  std::string stem = stem_of(files.ele);
  for (int without_quad = 0; without_quad < 2 && files.directions.empty(); ++without_quad) {
    for (const char* ending : {".ortho", ".axi", ".bases"})
      if (files.directions.empty()) files.directions = sibling(stem + ".ele", ending);
    if (stem.ends_with(kQuadratic)) stem.resize(stem.size() - kQuadratic.size());
  }
  return files;
}

DataSet read_tetgen(const TetgenFiles& files, const std::string& surface_markers,
                    std::vector<std::string>& notes) {
  const Nodes nodes = read_nodes(files.node, notes);
  std::vector<std::vector<double>> attributes;
  UnstructuredTopology topology = read_elements(files.ele, nodes, attributes, notes);
  const std::size_t elements = topology.types.size();
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(nodes.positions));
  DataSet mesh;
  mesh.topology = std::move(topology);
  if (!files.directions.empty()) {
    const std::string ending = ending_of(files.directions);
    DirectionRows rows{.numbers = ending == ".axi" ? 3 : 9, .numbered = ending == ".bases"};
    Directions directions;
    if (auto binary = ChasteBinary::open(files.directions); binary && !rows.numbered) {
      directions = read_binary_directions(*binary, elements, as_size(rows.numbers));
    } else {
      directions = read_direction_file(files.directions, elements, rows);
    }
    leave_out_missing(directions, notes);
    if (rows.places == kFramePlaces) {
      add_point_frames(directions.further, std::get<UnstructuredTopology>(mesh.topology), mesh, notes);
    } else {
      add_directions(directions, mesh);
    }
    if (rows.places > 1 && rows.places != kFramePlaces)
      notes.push_back("of " + counted(static_cast<std::uint64_t>(rows.places), "direction") +
                      " in each element, that at its centroid is taken");
    notes.push_back("fibres from " + files.directions);
  }
  if (!files.face.empty() && ChasteBinary::open(files.face)) {
    notes.push_back(files.face + " is binary: its markers are left out");
    if (!surface_markers.empty())
      throw usage_error("--surface-markers " + surface_markers + ": " + files.face +
                        " is binary, and not read");
  } else if (!files.face.empty()) {
    add_marked_surfaces(files.face, nodes.first, surface_markers, mesh, notes);
  } else if (!surface_markers.empty()) {
    throw usage_error("--surface-markers " + surface_markers + ": there is no .face file beside " +
                      files.ele);
  }
  add_attributes(nodes.attributes, Association::kPoint, mesh);
  add_attributes(attributes, Association::kCell, mesh);
  return mesh;
}

}  // namespace palpate
