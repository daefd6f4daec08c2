// Gmsh's .msh: sections between $Name and $EndName, in text or binary.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/layer/numbered_faces.h"
#include "common/field/layer/wall_surfaces.h"
#include "loaders/mesh/gmsh_values.h"
#include "loaders/mesh/mesh_file.h"
#include "loaders/mesh/mesh_words.h"

namespace palpate {
namespace {

constexpr std::int64_t kMostTag = std::numeric_limits<std::int64_t>::max() / 2;

/// An element of Gmsh as a cell of VTK's file format.
struct ElementType {
  int nodes = 0;
  int dimension = 0;
  std::uint8_t vtk = 0;            ///< 0: none
  std::array<std::int8_t, 27> of;  ///< which node of Gmsh's is each of the cell's; all 0: in their order
};

/// "Node ordering" of Gmsh's manual against VTK's file formats.
const ElementType* element_type(int type) {
  static const std::map<int, ElementType> kTypes{
      {1, {2, 1, 3, {}}},
      {2, {3, 2, 5, {}}},
      {3, {4, 2, 9, {}}},
      {4, {4, 3, 10, {}}},
      {5, {8, 3, 12, {}}},
      {6, {6, 3, 13, {}}},
      {7, {5, 3, 14, {}}},
      {8, {3, 1, 21, {}}},
      {9, {6, 2, 22, {}}},
      {10, {9, 2, 28, {}}},
      {11, {10, 3, 24, {0, 1, 2, 3, 4, 5, 6, 7, 9, 8}}},
      {12, {27, 3, 29, {0,  1,  2,  3,  4,  5,  6,  7,  8,  11, 13, 9,  16, 18,
                        19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26}}},
      {13, {18, 3, 32, {0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11, 15, 17, 16}}},
      {14, {14, 3, 0, {}}},
      {15, {1, 0, 1, {}}},
      {16, {8, 2, 23, {}}},
      {17, {20, 3, 25, {0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15}}},
      {18, {15, 3, 26, {0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11}}},
      {19, {13, 3, 27, {0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12}}},
      {20, {9, 2, 0, {}}},
      {21, {10, 2, 0, {}}},
      {22, {12, 2, 0, {}}},
      {23, {15, 2, 0, {}}},
      {24, {15, 2, 0, {}}},
      {25, {21, 2, 0, {}}},
      {26, {4, 1, 0, {}}},
      {27, {5, 1, 0, {}}},
      {28, {6, 1, 0, {}}},
      {29, {20, 3, 0, {}}},
      {30, {35, 3, 0, {}}},
      {31, {56, 3, 0, {}}},
      {36, {16, 2, 0, {}}},
      {37, {25, 2, 0, {}}},
      {38, {36, 2, 0, {}}},
      {90, {40, 3, 0, {}}},
      {91, {75, 3, 0, {}}},
      {92, {64, 3, 0, {}}},
      {93, {125, 3, 0, {}}}};
  const auto found = kTypes.find(type);
  return found == kTypes.end() ? nullptr : &found->second;
}

class GmshReader {
 public:
  GmshReader(std::string_view text, const std::string& file, std::optional<std::string> surface_markers)
      : words_(text, file), surface_markers_(std::move(surface_markers)) {}

  MeshFile read() {
    while (!words_.done()) {
      const std::string section(words_.word());
      if (section.substr(0, 1) != "$")
        words_.refuse("'" + printable(section.substr(0, 40)) + "'", "a section such as $Nodes");
      if (section != "$MeshFormat" && section != "$Comments" && version_ == 0.0)
        words_.refuse("'" + printable(section.substr(0, 40)) + "'", "$MeshFormat");
      if (section == "$MeshFormat") read_format();
      if (section == "$PhysicalNames") read_names();
      if (section == "$Entities" && version_ >= 4.0) read_entities();
      if (section == "$Nodes") version_ < 4.0 ? read_nodes_2() : read_nodes_4();
      if (section == "$Elements") version_ < 4.0 ? read_elements_2() : read_elements_4();
      if (section == "$NodeData") read_values(GmshValues::On::kNodes);
      if (section == "$ElementData") read_values(GmshValues::On::kElements);
      if (section == "$ElementNodeData") read_values(GmshValues::On::kElementNodes);
      if (section == "$InterpolationScheme") ++skipped_[section];
      // Others may be binary: periodic nodes, entities of partitions.
      words_.skip_behind("$End" + section.substr(1));
    }
    return made();
  }

 private:
  void read_format() {
    version_ = words_.number("a version");
    const std::int64_t binary = words_.integer("0 for text, 1 for binary", 0, 1);
    const std::int64_t size = words_.integer("the size of a number", 1, 16);
    if (version_ != 2.0 && version_ != 2.1 && version_ != 2.2 && version_ != 4.0 && version_ != 4.1) {
      words_.refuse("version " + short_number(version_), "2.0 to 2.2, 4.0 or 4.1",
                    "write it again: gmsh FILE -save -format msh41");
    }
    if (size != 8) words_.refuse("numbers of " + std::to_string(size) + " bytes", "8");
    binary_ = binary == 1;
    if (!binary_) return;
    words_.end_line();
    const auto one = words_.take<std::int32_t>(false, "the number one");
    swapped_ = one != 1;
    if (swapped_ && one != 0x01000000) words_.refuse("a byte order that is none", "the number one");
  }

  std::int64_t int32() { return words_.take<std::int32_t>(swapped_, "a number"); }
  std::int64_t size64() {
    const auto value = words_.take<std::uint64_t>(swapped_, "a number");
    if (value > static_cast<std::uint64_t>(kMostTag))
      words_.refuse("a number beyond all bounds", "one that can be");
    return static_cast<std::int64_t>(value);
  }
  double real() { return words_.take<double>(swapped_, "a coordinate"); }
  /// Of as many things as the rest of the file can hold.
  std::size_t believed(std::int64_t count, std::size_t least_bytes) {
    if (count < 0 || as_size(count) > words_.left() / least_bytes + 1)
      words_.refuse("a count of " + std::to_string(count), "no more than the file can hold",
                    "the file may be truncated");
    return as_size(count);
  }

  void read_names() {
    const std::size_t count = words_.count("a count of names", 5);
    for (std::size_t n = 0; n < count; ++n) {
      const std::int64_t dimension = words_.integer("a dimension", 0, 3);
      const std::int64_t group = words_.integer("the number of a physical group", -kMostTag, kMostTag);
      const std::string name(words_.word());
      if (dimension == kSurface) names_[group] = printable(name.substr(0, 60));
    }
  }

  /// The physical groups of each surface; the rest says where entities lie and what bounds them.
  void read_entities() {
    if (binary_) words_.end_line();
    const auto next = [&] { return binary_ ? size64() : words_.integer("a count", 0, kMostTag); };
    const auto tag = [&] { return binary_ ? int32() : words_.integer("a tag", -kMostTag, kMostTag); };
    std::array<std::int64_t, 4> counts{};
    for (std::int64_t& count : counts) count = static_cast<std::int64_t>(believed(next(), 4));
    for (int dimension = 0; dimension < 4; ++dimension) {
      for (std::int64_t e = 0; e < counts[as_size(dimension)]; ++e) {
        const std::int64_t entity = tag();
        for (int i = 0, box = dimension == 0 && !is_40() ? 3 : 6; i < box; ++i)
          (void)(binary_ ? real() : words_.number("a coordinate"));
        for (std::size_t i = 0, groups = believed(next(), 1); i < groups; ++i) {
          const std::int64_t group = tag();
          if (dimension == kSurface) groups_of_[entity].push_back(group);
        }
        for (std::size_t i = 0, around = dimension == 0 ? 0 : believed(next(), 1); i < around; ++i)
          (void)tag();
      }
    }
  }

  void add_node(std::int64_t tag, const Vec3& x) {
    if (!mesh_.point_of.try_emplace(tag, mesh_.positions.size() / 3).second)
      words_.refuse("a second node " + std::to_string(tag), "one");
    for (int i = 0; i < 3; ++i) mesh_.positions.push_back(x[i]);
  }

  void read_nodes_2() {
    const std::size_t count = words_.count("a count of nodes", 8);
    if (binary_) words_.end_line();
    for (std::size_t n = 0; n < count; ++n) {
      const std::int64_t tag = binary_ ? int32() : words_.integer("the number of a node", 0, kMostTag);
      Vec3 x{0.0};
      for (int i = 0; i < 3; ++i) x[i] = binary_ ? real() : words_.number("a coordinate");
      add_node(tag, x);
    }
    expect_end("$EndNodes");
  }

  /// Version 4.0 counts nothing beside blocks and nodes, has the entity before its dimension, every node's number
  /// beside its coordinates, and numbers of four bytes.
  [[nodiscard]] bool is_40() const noexcept { return version_ < 4.1; }
  std::int64_t tag_40(const char* what) { return binary_ ? int32() : words_.integer(what, 0, kMostTag); }

  void read_nodes_4() {
    const auto next = [&](const char* what) {
      return binary_ ? size64() : words_.integer(what, 0, kMostTag);
    };
    if (binary_) words_.end_line();
    const std::size_t blocks = believed(next("a count of blocks"), 4);
    for (int i = 0; i < (is_40() ? 1 : 3); ++i) (void)next("a number of nodes");
    for (std::size_t b = 0; b < blocks; ++b) {
      std::array<std::int64_t, 2> place{};  // dimension and entity; in 4.0 the other way round
      for (std::int64_t& part : place)
        part = binary_ ? int32() : words_.integer("an entity", -kMostTag, kMostTag);
      const std::int64_t dimension = place[is_40() ? 1 : 0];
      const std::int64_t parametric = binary_ ? int32() : words_.integer("0 or 1", 0, 1);
      if (dimension < 0 || dimension > 3 || parametric < 0 || parametric > 1)
        words_.refuse("nodes of dimension " + std::to_string(dimension), "0 to 3");
      const std::size_t count = believed(next("a count of nodes"), 2);
      std::vector<std::int64_t> tags(is_40() ? 0 : count);
      for (std::int64_t& tag : tags) tag = next("the number of a node");
      for (std::size_t n = 0; n < count; ++n) {
        const std::int64_t tag = is_40() ? tag_40("the number of a node") : tags[n];
        Vec3 x{0.0};
        for (int i = 0; i < 3; ++i) x[i] = binary_ ? real() : words_.number("a coordinate");
        for (std::int64_t i = 0; i < parametric * dimension; ++i)
          (void)(binary_ ? real() : words_.number("a coordinate"));
        add_node(tag, x);
      }
    }
    expect_end("$EndNodes");
  }

  /// @param nodes their tags, in Gmsh's order. @param groups physical ones.
  void add_element(const ElementType& type, std::int64_t tag, std::span<const std::int64_t> nodes,
                   std::span<const std::int64_t> groups) {
    if (type.dimension < 3) {
      ++flat_;
      // Those of the other orientation are negative.
      for (const std::int64_t group : groups) {
        if (type.dimension != kSurface || group == 0) continue;
        numbers_.insert(std::abs(group));
        if (surface_markers_) faces_.add(nodes, std::abs(group));
      }
      return;
    }
    if (type.vtk == 0) {
      ++unread_;
      return;
    }
    std::array<std::int64_t, 27> points{};
    const bool own_order = std::ranges::all_of(type.of, [](std::int8_t n) { return n == 0; });
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::int64_t node = nodes[own_order ? i : as_size(type.of[i])];
      const auto found = mesh_.point_of.find(node);
      if (found == mesh_.point_of.end())
        words_.refuse("element " + std::to_string(tag) + " of node " + std::to_string(node),
                      "a node that there is");
      points[i] = static_cast<std::int64_t>(found->second);
    }
    mesh_.cell_of.try_emplace(tag, cells_.size());
    mesh_.order_of.emplace_back(own_order ? nullptr : type.of.data());
    cells_.add(type.vtk, points.data(), nodes.size());
  }
  const ElementType& known_type(std::int64_t type) {
    const ElementType* const known = type > 0 && type < 1000 ? element_type(static_cast<int>(type)) : nullptr;
    if (known == nullptr) {
      words_.refuse("elements of type " + std::to_string(type), "a type of up to the fourth order",
                    "write the mesh again at a lower order: gmsh FILE -save -order 2");
    }
    return *known;
  }

  void read_elements_2() {
    const std::size_t count = words_.count("a count of elements", 6);
    if (binary_) words_.end_line();
    std::vector<std::int64_t> nodes;
    for (std::size_t n = 0; n < count;) {
      if (!binary_) {
        const std::int64_t tag = words_.integer("the number of an element", 0, kMostTag);
        const ElementType& type = known_type(words_.integer("a type", 0, kMostTag));
        std::int64_t group = 0;
        for (std::int64_t i = 0, n = words_.integer("a count of tags", 0, 1000); i < n; ++i) {
          const std::int64_t one = words_.integer("a tag", -kMostTag, kMostTag);
          if (i == 0) group = one;
        }
        nodes.resize(as_size(type.nodes));
        for (std::int64_t& node : nodes) node = words_.integer("a node", 0, kMostTag);
        add_element(type, tag, nodes, {&group, 1});
        ++n;
        continue;
      }
      const ElementType& type = known_type(int32());
      const std::size_t here = believed(int32(), 8);
      const std::int64_t tags = int32();
      if (here == 0 || here > count - n || tags < 0 || tags > 1000)
        words_.refuse("a block of elements that cannot be", "one");
      nodes.resize(as_size(type.nodes));
      for (std::size_t e = 0; e < here; ++e) {
        const std::int64_t tag = int32();
        std::int64_t group = 0;
        for (std::int64_t i = 0; i < tags; ++i) {
          const std::int64_t one = int32();
          if (i == 0) group = one;
        }
        for (std::int64_t& node : nodes) node = int32();
        add_element(type, tag, nodes, {&group, 1});
      }
      n += here;
    }
    expect_end("$EndElements");
  }

  void read_elements_4() {
    const auto next = [&](const char* what) {
      return binary_ ? size64() : words_.integer(what, 0, kMostTag);
    };
    if (binary_) words_.end_line();
    const std::size_t blocks = believed(next("a count of blocks"), 4);
    for (int i = 0; i < (is_40() ? 1 : 3); ++i) (void)next("a number of elements");
    std::vector<std::int64_t> nodes;
    for (std::size_t b = 0; b < blocks; ++b) {
      std::array<std::int64_t, 2> place{};  // dimension and entity; in 4.0 the other way round
      for (std::int64_t& part : place)
        part = binary_ ? int32() : words_.integer("an entity", -kMostTag, kMostTag);
      static const std::vector<std::int64_t> kNone;
      const auto known = groups_of_.find(place[is_40() ? 0 : 1]);
      const bool surface = place[is_40() ? 1 : 0] == kSurface;
      const std::vector<std::int64_t>& groups = known == groups_of_.end() || !surface ? kNone : known->second;
      const ElementType& type = known_type(binary_ ? int32() : words_.integer("a type", 0, kMostTag));
      const std::size_t count = believed(next("a count of elements"), 2);
      nodes.resize(as_size(type.nodes));
      for (std::size_t e = 0; e < count; ++e) {
        const std::int64_t tag =
            is_40() ? tag_40("the number of an element") : next("the number of an element");
        for (std::int64_t& node : nodes) node = is_40() ? tag_40("a node") : next("a node");
        add_element(type, tag, nodes, groups);
      }
    }
    expect_end("$EndElements");
  }

  void read_values(GmshValues::On on) {
    GmshValues values;
    values.on = on;
    for (std::int64_t i = 0, n = words_.integer("a count of names", 0, 1000); i < n; ++i) {
      const std::string_view name = words_.word();
      if (i == 0) values.name = name;
      // The numbers are coefficients of functions that $InterpolationScheme names.
      values.coefficients = values.coefficients || (i == 1 && !name.empty());
    }
    for (std::int64_t i = 0, n = words_.integer("a count of numbers", 0, 1000); i < n; ++i) {
      const double real_tag = words_.number("a time");
      if (i > 0) continue;
      if (!std::isfinite(real_tag)) words_.refuse("a time that is no number", "a time");
      values.time = real_tag;
    }
    std::array<std::int64_t, 3> whole{0, 1, 0};
    for (std::int64_t i = 0, n = words_.integer("a count of whole numbers", 3, 1000); i < n; ++i) {
      const std::int64_t value = words_.integer("a whole number", 0, kMostTag);
      if (i < 3) whole[as_size(i)] = value;
    }
    values.step = whole[0];
    if (whole[1] != 1 && whole[1] != 3 && whole[1] != 9)
      words_.refuse(std::to_string(whole[1]) + " components", "1, 3 or 9");
    values.components = static_cast<int>(whole[1]);
    const std::size_t count = believed(whole[2], 4);
    if (values.name.empty()) values.name = on == GmshValues::On::kNodes ? "node data" : "element data";
    if (binary_) words_.end_line();
    for (std::size_t n = 0; n < count; ++n) {
      const std::int64_t tag = binary_ ? int32() : words_.integer("a number", 0, kMostTag);
      std::int64_t nodes = 1;
      if (on == GmshValues::On::kElementNodes)
        nodes = binary_ ? int32() : words_.integer("a count of nodes", 0, kMostTag);
      values.tuples.push_back({tag, values.numbers.size(), believed(nodes, 2)});
      for (std::int64_t c = 0; c < values.components * nodes; ++c)
        values.numbers.push_back(binary_ ? real() : words_.number("a value"));
    }
    expect_end(on == GmshValues::On::kNodes      ? "$EndNodeData"
               : on == GmshValues::On::kElements ? "$EndElementData"
                                                 : "$EndElementNodeData");
    values_.push_back(std::move(values));
  }

  /// One number too many, or too few, is an error.
  void expect_end(std::string_view end) {
    if (const std::string_view word = words_.peek(); word != end) {
      (void)words_.word();
      words_.refuse("'" + printable(word.substr(0, 40)) + "'",
                    std::string(end) + " after as many as were counted");
    }
  }

  MeshFile made() {
    if (mesh_.positions.empty()) words_.refuse("no $Nodes", "a mesh");
    MeshFile out;
    if (cells_.size() == 0) {
      throw input_error({words_.file(), "",
                         unread_ > 0 ? "has volume elements of higher order only, which are not read"
                                     : "has no volume elements (" + counted(flat_, "other element") + ")",
                         "tetrahedra, hexahedra, wedges or pyramids up to the second order",
                         unread_ > 0 ? "write it at a lower order: gmsh FILE -save -order 2"
                                     : "mesh the volume: gmsh FILE -3"});
    }
    out.faces = !numbers_.empty();
    std::string of_groups;
    constexpr std::size_t kMostListed = 12;
    std::size_t listed = 0;
    for (const std::int64_t group : numbers_) {
      if (listed++ == kMostListed) {
        of_groups += ", … (" + std::to_string(numbers_.size()) + " in all)";
        break;
      }
      const auto name = names_.find(group);
      of_groups += (of_groups.empty() ? ", of the physical groups " : ", ") + std::to_string(group) +
                   (name == names_.end() ? "" : " '" + name->second + "'");
    }
    if (flat_ > 0)
      out.notes.push_back(counted(flat_, "element") + " of lower dimension left out" + of_groups);
    if (unread_ > 0) {
      out.notes.push_back(
          counted(unread_, "volume element") +
          " of a kind that is not read (third order and higher, pyramids of 14 nodes) left out");
    }
    for (const auto& [section, count] : skipped_)
      out.notes.push_back(counted(count, "section") + " " + section + " left out");

    if (surface_markers_ && (!numbers_.empty() || !surface_markers_->empty())) add_surfaces(out.notes);
    cells_.take(mesh_.cells);
    add_gmsh_values(std::move(mesh_), std::move(values_), words_.file(), out);
    return out;
  }

  /// As values of the nodes, which stand at all times.
  void add_surfaces(std::vector<std::string>& notes) {
    NumberedFaces faces;
    std::vector<std::int64_t> points;
    for (std::size_t f = 0; f < faces_.numbers.size(); ++f) {
      points.clear();
      for (std::int64_t i = faces_.offsets[f]; i < faces_.offsets[f + 1]; ++i) {
        const auto found = mesh_.point_of.find(faces_.points[as_size(i)]);
        if (found != mesh_.point_of.end()) points.push_back(static_cast<std::int64_t>(found->second));
      }
      faces.add(points, faces_.numbers[f]);
    }
    const FaceWords words{.file = words_.file(),
                          .numbered_by = "the physical groups",
                          .names = names_,
                          .asked = *surface_markers_};
    std::vector<std::string> said;
    const std::vector<double> tags = surfaces_of_faces(faces, mesh_.positions.size() / 3, words, said);
    if (tags.empty()) return;  // a mesh of something else: groups are listed already
    notes.insert(notes.end(), said.begin(), said.end());
    GmshValues values;
    values.name = kSurfaceArray;
    for (const auto& [tag, point] : mesh_.point_of) {
      values.tuples.push_back({tag, values.numbers.size(), 1});
      values.numbers.push_back(tags[point]);
    }
    values_.push_back(std::move(values));
  }

  static constexpr int kSurface = 2;  // its dimension

  MeshWords words_;
  std::optional<std::string> surface_markers_;                             ///< null: no wall
  std::map<std::int64_t, std::string> names_;                              ///< of physical groups of surfaces
  std::unordered_map<std::int64_t, std::vector<std::int64_t>> groups_of_;  ///< of surfaces; version 4
  std::set<std::int64_t> numbers_;                                         ///< of groups that have a surface
  NumberedFaces faces_;                                                    ///< of a wall, of nodes' tags
  double version_ = 0.0;
  bool binary_ = false, swapped_ = false;
  GmshMesh mesh_;
  CellList cells_;
  std::size_t flat_ = 0, unread_ = 0;
  std::map<std::string, std::size_t> skipped_;
  std::vector<GmshValues> values_;
};

}  // namespace

MeshFile read_gmsh(std::string_view text, const std::string& file,
                   const std::optional<std::string>& surface_markers) {
  return GmshReader(text, file, surface_markers).read();
}

}  // namespace palpate
