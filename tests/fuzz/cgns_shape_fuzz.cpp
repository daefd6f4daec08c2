// What is looked for in the nodes of a CGNS file, over nodes that stand in memory alone: HDF5, which takes most of the time of a file, has no
// part in it. Six bytes a time edit a file of one zone.
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "loaders/hdf/cgns_file.h"
#include "loaders/hdf/cgns_shape.h"

namespace palpate {
namespace {

struct Node {
  std::string label, word;
  std::vector<std::int64_t> numbers;
  std::uint64_t count = 0;
};

std::map<std::string, Node> nodes;  // by their paths, of the one file that there is

/// "/Base//Zone" is "Base/Zone".
std::string plain(const std::string& path) {
  std::string out;
  for (const char c : path)
    if (c != '/' || (!out.empty() && out.back() != '/')) out += c;
  return out;
}

const Node& find(const std::string& path) {
  static const Node kNone;
  const auto found = nodes.find(plain(path));
  return found == nodes.end() ? kNone : found->second;
}

}  // namespace

// In place of loaders/hdf/cgns_file.cpp.
CgnsFile::CgnsFile(const std::string&) : file_(0) {}
CgnsFile::~CgnsFile() = default;
bool CgnsFile::has(const std::string& node) const { return !find(node).label.empty(); }
std::string CgnsFile::label(const std::string& node) const { return find(node).label; }
std::uint64_t CgnsFile::count(const std::string& node) const { return find(node).count; }
int CgnsFile::axes(const std::string& node) const { return find(node).numbers.empty() ? 0 : 1; }
std::string CgnsFile::word(const std::string& node) const { return find(node).word; }
std::vector<std::int64_t> CgnsFile::numbers(const std::string& node, std::uint64_t most) const {
  const Node& found = find(node);
  return found.numbers.size() > most ? std::vector<std::int64_t>() : found.numbers;
}
std::vector<std::string> CgnsFile::children(const std::string& node) const {
  std::vector<std::string> out;
  std::string above = plain(node);
  if (!above.empty()) above += '/';
  for (const auto& [path, child] : nodes) {
    if (path.size() > above.size() && path.starts_with(above) &&
        path.find('/', above.size()) == std::string::npos)
      out.push_back(path.substr(above.size()));
  }
  return out;
}

namespace {

/// One hexahedron.
void begin(bool structured) {
  nodes.clear();
  nodes["Base"] = {"CGNSBase_t", "", {3, 3}, 2};
  nodes["Base/Zone"] = {"Zone_t", "", {8, 1, 0}, 3};
  nodes["Base/Zone/ZoneType"] = {"ZoneType_t", structured ? "Structured" : "Unstructured", {}, 12};
  const std::string places = "Base/Zone/GridCoordinates", elements = "Base/Zone/Elem";
  nodes[places] = {"GridCoordinates_t", "", {}, 0};
  for (const char* axis : {"X", "Y", "Z"}) nodes[places + "/Coordinate" + axis] = {"DataArray_t", "", {}, 8};
  constexpr std::int64_t kHexahedra = 17;
  nodes[elements] = {"Elements_t", "", {kHexahedra, 0}, 2};
  nodes[elements + "/ElementRange"] = {"IndexRange_t", "", {1, 1}, 2};
  nodes[elements + "/ElementConnectivity"] = {"DataArray_t", "", {1, 2, 3, 4, 5, 6, 7, 8}, 8};
}

/// Small ones, negative ones, kinds of elements, and those at the ends of their types.
std::int64_t value_of(std::uint8_t kind, std::uint8_t number) {
  constexpr std::array<std::int64_t, 12> kEnds{INT64_MAX,  INT64_MIN, INT32_MAX, -1, 0,  1LL << 32U,
                                               1LL << 62U, 3,         8,         17, 20, 22};
  if (kind % 3 == 0) return kEnds[number % kEnds.size()];
  return kind % 3 == 1 ? -static_cast<std::int64_t>(number) : number;
}

void edit(const std::uint8_t* six, std::vector<std::string>& paths) {
  constexpr std::array kLabels{
      "CGNSBase_t",     "Zone_t",       "ZoneType_t",     "GridCoordinates_t",   "DataArray_t", "Elements_t",
      "FlowSolution_t", "IndexRange_t", "GridLocation_t", "ZoneIterativeData_t", "Rind_t",      "odd"};
  constexpr std::array kNames{"Base",
                              "Zone",
                              "ZoneType",
                              "GridCoordinates",
                              "CoordinateX",
                              "Elem",
                              "ElementRange",
                              "ElementConnectivity",
                              "ElementStartOffset",
                              "FlowSolution",
                              "VelocityX",
                              "GridLocation",
                              " data",
                              " link",
                              "ParentElements",
                              "Rind"};
  constexpr std::array kWords{"Structured", "Unstructured", "Vertex", "CellCenter", ""};
  constexpr std::size_t kLongest = 200, kMost = 40;
  const std::string at = paths[six[1] % paths.size()];
  Node& node = nodes[at];
  const std::int64_t value = value_of(six[3], six[4]);
  switch (six[0] % 7) {
    case 0:
      nodes.erase(at);
      break;
    case 1: {
      const std::string child = at + "/" + kNames[six[2] % kNames.size()];
      if (child.size() > kLongest) break;
      nodes[child] = {kLabels[six[3] % kLabels.size()], kWords[six[4] % kWords.size()], {}, six[5]};
      paths.push_back(child);
      break;
    }
    case 2:
      node.label = kLabels[six[2] % kLabels.size()];
      break;
    case 3:
      node.word = kWords[six[2] % kWords.size()];
      break;
    case 4:
      if (!node.numbers.empty()) node.numbers[six[2] % node.numbers.size()] = value;
      break;
    case 5:
      node.numbers.resize(six[2] % kMost, value);
      node.count = node.numbers.size();
      break;
    default:
      node.count = static_cast<std::uint64_t>(value);
  }
}

}  // namespace
}  // namespace palpate

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace palpate;
  constexpr std::size_t kEdit = 6;
  begin(size > 0 && data[0] % 2 != 0);
  std::vector<std::string> paths;
  for (const auto& [path, node] : nodes) paths.push_back(path);
  for (std::size_t i = 1; i + kEdit <= size; i += kEdit) edit(data + i, paths);
  (void)find_cgns_problem(CgnsFile(""));
  return 0;
}
