// AVS's unstructured cell data in text (AVS Developer's Guide, "UCD"): counts; nodes; cells; data of nodes; of cells.
#include <array>
#include <limits>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "loaders/mesh/mesh_file.h"
#include "loaders/mesh/mesh_words.h"

namespace palpate {
namespace {

constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max() / 2;

struct UcdType {
  int nodes = 0;
  std::uint8_t vtk = 0;             ///< 0: no volume
  std::array<std::size_t, 8> of{};  ///< which node of UCD's is each of the cell's
};

/// The first face of UCD's is that on top, and the tip of a pyramid comes first.
const std::map<std::string, UcdType, std::less<>>& types() {
  static const std::map<std::string, UcdType, std::less<>> kTypes{{"pt", {1, 0, {}}},
                                                                  {"line", {2, 0, {}}},
                                                                  {"tri", {3, 0, {}}},
                                                                  {"quad", {4, 0, {}}},
                                                                  {"tet", {4, 10, {0, 1, 2, 3}}},
                                                                  {"pyr", {5, 14, {1, 2, 3, 4, 0}}},
                                                                  {"prism", {6, 13, {0, 1, 2, 3, 4, 5}}},
                                                                  {"hex", {8, 12, {4, 5, 6, 7, 0, 1, 2, 3}}}};
  return kTypes;
}

/// The values of nodes or of cells: how many components there are and of how many numbers each, their names, a row each.
void read_data(MeshWords& words, const std::unordered_map<std::int64_t, std::size_t>& index, std::size_t rows,
               std::size_t tuples, Association association, DataSet& block) {
  const auto count = as_size(words.integer("a count of components", 1, 1000));
  std::vector<int> sizes;
  std::size_t numbers = 0;
  for (std::size_t c = 0; c < count; ++c) {
    sizes.push_back(static_cast<int>(words.integer("the size of a component", 1, 100)));
    numbers += as_size(sizes.back());
  }
  (void)words.rest_of_line();
  std::vector<std::string> names;
  for (std::size_t c = 0; c < count; ++c) {
    const std::string_view line = words.rest_of_line();
    names.emplace_back(trimmed(line.substr(0, line.find(','))));
    if (names.back().empty()) names.back() = "component " + std::to_string(c + 1);
  }
  std::vector<std::vector<double>> values;
  for (const int size : sizes) {
    if (numbers * tuples > words.left())
      words.refuse("ends", "a row of values for each", "the file may be truncated");
    values.emplace_back(as_size(size) * tuples, std::numeric_limits<double>::quiet_NaN());
  }
  for (std::size_t r = 0; r < rows; ++r) {
    const std::int64_t id = words.integer("a number", -kMost, kMost);
    const auto at = index.find(id);
    for (std::size_t c = 0; c < count; ++c) {
      for (int i = 0; i < sizes[c]; ++i) {
        const double value = words.number("a value");
        if (at != index.end()) values[c][as_size(sizes[c]) * at->second + as_size(i)] = value;
      }
    }
  }
  for (std::size_t c = 0; c < count; ++c)
    block.arrays.push_back(mesh_array(names[c], association, sizes[c], values[c]));
}

}  // namespace

MeshFile read_ucd(std::string_view text, const std::string& file) {
  MeshWords words(text, file, '#');
  const std::size_t nodes = words.count("a count of nodes", 8), cells = words.count("a count of cells", 8);
  const auto of_nodes = words.integer("a count of values of nodes", 0, 10000);
  const auto of_cells = words.integer("a count of values of cells", 0, 10000);
  (void)words.integer("a count of values of the model", 0, 10000);
  (void)words.rest_of_line();
  MeshFile out;
  DataSet block;
  std::vector<double> positions;
  std::unordered_map<std::int64_t, std::size_t> node_of, cell_of, flat_of;
  for (std::size_t n = 0; n < nodes; ++n) {
    const std::int64_t id = words.integer("the number of a node", -kMost, kMost);
    if (!node_of.try_emplace(id, n).second) words.refuse("a second node " + std::to_string(id), "one");
    for (int i = 0; i < 3; ++i) positions.push_back(words.number("a coordinate"));
    (void)words.rest_of_line();
  }
  CellList list;
  for (std::size_t c = 0; c < cells; ++c) {
    const std::int64_t id = words.integer("the number of a cell", -kMost, kMost);
    (void)words.integer("a material", -kMost, kMost);
    const std::string name(words.word());
    const auto known = types().find(name);
    if (known == types().end())
      words.refuse("'" + printable(name.substr(0, 40)) + "'", "pt, line, tri, quad, tet, pyr, prism or hex");
    const UcdType& type = known->second;
    std::array<std::int64_t, 8> given{}, points{};
    for (int i = 0; i < type.nodes; ++i) {
      const std::int64_t node = words.integer("a node", -kMost, kMost);
      const auto found = node_of.find(node);
      if (found == node_of.end()) words.refuse("node " + std::to_string(node), "a node that there is");
      given[as_size(i)] = static_cast<std::int64_t>(found->second);
    }
    if (type.vtk == 0) {
      flat_of.try_emplace(id, c);
      continue;
    }
    for (int i = 0; i < type.nodes; ++i) points[as_size(i)] = given[type.of[as_size(i)]];
    cell_of.try_emplace(id, list.size());
    list.add(type.vtk, points.data(), as_size(type.nodes));
  }
  if (list.size() == 0) throw input_error({file, "", "has no volume cells", "tet, pyr, prism or hex", ""});
  if (!flat_of.empty()) out.notes.push_back(counted(flat_of.size(), "cell") + " of lower dimension left out");
  const std::size_t volume_cells = list.size();
  UnstructuredTopology mesh;
  mesh.positions = mesh_array("positions", Association::kPoint, 3, positions);
  list.take(mesh);
  block.topology = std::move(mesh);
  if (of_nodes > 0) read_data(words, node_of, nodes, nodes, Association::kPoint, block);
  if (of_cells > 0) read_data(words, cell_of, cells, volume_cells, Association::kCell, block);
  out.steps.push_back({std::move(block)});
  return out;
}

}  // namespace palpate
