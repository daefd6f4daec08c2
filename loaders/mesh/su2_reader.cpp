// SU2's native mesh: NDIME= 3, NELEM= n and a line for each element (its type as VTK numbers it, its nodes), NPOIN= n
// and a line for each node. Further numbers on a line are indices that nothing needs.
#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "loaders/mesh/mesh_file.h"
#include "loaders/mesh/mesh_words.h"

namespace palpate {

MeshFile read_su2(std::string_view text, const std::string& file) {
  static const std::map<std::int64_t, int> kNodes{{3, 2}, {5, 3}, {9, 4}, {10, 4}, {12, 8}, {13, 6}, {14, 5}};
  MeshWords words(text, file, '%');
  MeshFile out;
  std::vector<DataSet> blocks;
  CellList cells;
  std::vector<double> positions;
  std::int64_t most_node = -1;
  std::size_t flat = 0;
  const auto close = [&] {
    if (positions.empty() && cells.size() == 0) return;
    if (most_node >= static_cast<std::int64_t>(positions.size() / 3))
      words.refuse("an element of node " + std::to_string(most_node),
                   "one of " + std::to_string(positions.size() / 3) + " nodes, counted from 0");
    UnstructuredTopology mesh;
    mesh.positions = mesh_array("positions", Association::kPoint, 3, positions);
    cells.take(mesh);
    DataSet block;
    if (!blocks.empty()) block.name = "zone " + std::to_string(blocks.size() + 1);
    block.topology = std::move(mesh);
    blocks.push_back(std::move(block));
    cells = CellList();
    positions.clear();
    most_node = -1;
  };
  while (!words.done()) {
    // "NELEM= 5" and "NELEM=5" and "NELEM = 5".
    std::string key(words.word());
    const std::size_t equal = key.find('=');
    std::string value = equal == std::string::npos ? std::string() : key.substr(equal + 1);
    key.resize(std::min(equal, key.size()));
    if (equal == std::string::npos) {
      if (words.peek().substr(0, 1) != "=")
        words.refuse("'" + printable(key.substr(0, 40)) + "'", "an entry such as NELEM= 5");
      value = std::string(words.word()).substr(1);
    }
    const auto whole = [&](const char* what, std::int64_t least) {
      if (value.empty()) return words.integer(what, least, std::int64_t{1} << 40U);
      const auto found = parsed<std::int64_t>(value);
      if (!found || *found < least) words.refuse("'" + printable(value.substr(0, 40)) + "'", what);
      return *found;
    };
    if (key == "NDIME") {
      const std::int64_t dimension = whole("the dimension", 1);
      if (dimension != 3)
        throw input_error(
            {file, "", "is a mesh of " + std::to_string(dimension) + " dimensions", "a volume", ""});
    } else if (key == "IZONE") {
      (void)whole("a zone", 0);
      close();
    } else if (key == "NELEM") {
      const std::int64_t count = whole("a count of elements", 0);
      (void)words.rest_of_line();
      for (std::int64_t n = 0; n < count; ++n) {
        const std::int64_t type = words.integer("the type of an element", 0, 100);
        const auto known = kNodes.find(type);
        if (known == kNodes.end())
          words.refuse("an element of type " + std::to_string(type), "10, 12, 13 or 14");
        std::array<std::int64_t, 8> nodes{};
        for (int i = 0; i < known->second; ++i) {
          nodes[as_size(i)] = words.integer("a node", 0, std::int64_t{1} << 40U);
          most_node = std::max(most_node, nodes[as_size(i)]);
        }
        (void)words.rest_of_line();
        if (type < 10) {
          ++flat;
        } else {
          cells.add(static_cast<std::uint8_t>(type), nodes.data(), as_size(known->second));
        }
      }
    } else if (key == "NPOIN") {
      const std::int64_t count = whole("a count of nodes", 0);
      (void)words.rest_of_line();
      for (std::int64_t n = 0; n < count; ++n) {
        for (int i = 0; i < 3; ++i) positions.push_back(words.number("a coordinate"));
        (void)words.rest_of_line();
      }
    } else if (key == "MARKER_ELEMS") {
      const std::int64_t count = whole("a count of elements", 0);
      (void)words.rest_of_line();
      for (std::int64_t n = 0; n < count && !words.done(); ++n) (void)words.rest_of_line();
    } else {
      // Its lines, up to the next entry.
      (void)words.rest_of_line();
      for (MeshWords ahead = words; !ahead.done(); words = ahead) {
        if (ahead.rest_of_line().find('=') != std::string_view::npos) break;
      }
    }
  }
  close();
  if (blocks.empty() || (blocks.size() == 1 && blocks.front().cell_count() == 0))
    throw input_error({file, "", "has no volume elements", "tetrahedra, hexahedra, wedges or pyramids", ""});
  if (flat > 0) out.notes.push_back(counted(flat, "element") + " of lower dimension left out");
  out.notes.emplace_back("an SU2 mesh holds no flow: open the solution as SU2 writes it, .vtu or .vtk");
  out.steps.push_back(std::move(blocks));
  return out;
}

}  // namespace palpate
