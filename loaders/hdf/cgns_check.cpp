#include "loaders/hdf/cgns_check.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <hdf5.h>

#include "common/base/error.h"
#include "common/base/index.h"

namespace palpate {
namespace {

constexpr std::array<std::uint64_t, 22> kNodesOfElement{0,  0, 1,  2, 3,  3,  6, 4,  8,  9, 4,
                                                        10, 5, 14, 6, 15, 18, 8, 20, 27, 0, 13};

class CgnsFile {
 public:
  explicit CgnsFile(const std::string& file) : file_(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {}
  ~CgnsFile() {
    if (file_ >= 0) H5Fclose(file_);
  }
  CgnsFile(const CgnsFile&) = delete;
  CgnsFile& operator=(const CgnsFile&) = delete;

  [[nodiscard]] hid_t id() const { return file_; }
  [[nodiscard]] bool has(const std::string& node) const {
    return H5Lexists(file_, node.c_str(), H5P_DEFAULT) > 0;
  }
  [[nodiscard]] std::string label(const std::string& node) const {
    constexpr std::size_t kLength = 33;
    if (H5Aexists_by_name(file_, node.c_str(), "label", H5P_DEFAULT) <= 0) return {};
    const hid_t attribute = H5Aopen_by_name(file_, node.c_str(), "label", H5P_DEFAULT, H5P_DEFAULT);
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, kLength);
    std::array<char, kLength + 1> text{};
    H5Aread(attribute, type, text.data());
    H5Tclose(type);
    H5Aclose(attribute);
    return text.data();
  }
  /// How many numbers a node holds.
  [[nodiscard]] std::uint64_t count(const std::string& node) const {
    const hid_t set = H5Dopen2(file_, (node + "/ data").c_str(), H5P_DEFAULT);
    if (set < 0) return 0;
    const hid_t space = H5Dget_space(set);
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    H5Sclose(space);
    H5Dclose(set);
    return count < 0 ? 0 : static_cast<std::uint64_t>(count);
  }
  /// The whole numbers of a node, few of them.
  [[nodiscard]] std::vector<std::int64_t> numbers(const std::string& node) const {
    constexpr std::uint64_t kMost = 64;
    const std::uint64_t n = has(node + "/ data") ? count(node) : 0;
    if (n == 0 || n > kMost) return {};
    std::vector<std::int64_t> out(n);
    const hid_t set = H5Dopen2(file_, (node + "/ data").c_str(), H5P_DEFAULT);
    const bool read = H5Dread(set, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()) >= 0;
    H5Dclose(set);
    return read ? out : std::vector<std::int64_t>{};
  }
  [[nodiscard]] std::string word(const std::string& node) const {
    std::string text;
    for (const std::int64_t c : numbers(node)) text += static_cast<char>(c);
    return text;
  }

 private:
  hid_t file_;
};

struct Walk {
  const CgnsFile& file;
  std::string node, problem;
};

std::string above(const std::string& node) { return node.substr(0, node.find_last_of('/')); }

/// Points, or cells, of a zone by its sizes; nothing where these are of no sense.
std::optional<std::uint64_t> size_of_zone(const CgnsFile& file, const std::string& zone, bool cells) {
  const std::vector<std::int64_t> sizes = file.numbers(zone);
  const std::size_t axes = sizes.size() / 3;
  if (sizes.empty() || sizes.size() % 3 != 0) return std::nullopt;
  std::uint64_t product = 1;
  for (std::size_t axis = 0; axis < axes; ++axis) {
    const std::int64_t size = sizes[(cells ? axes : 0) + axis];
    if (size < 0 || __builtin_mul_overflow(product, static_cast<std::uint64_t>(size), &product))
      return std::nullopt;
  }
  return product;
}

/// How many numbers an array is to have; nothing where that is not known here.
std::optional<std::uint64_t> due(const CgnsFile& file, const std::string& node) {
  const std::string group = above(node);
  const std::string kind = file.label(group);
  if (kind == "Elements_t" && node.substr(group.size() + 1) == "ElementConnectivity") {
    const std::vector<std::int64_t> about = file.numbers(group),
                                    range = file.numbers(group + "/ElementRange");
    if (about.empty() || range.size() != 2 || range[1] < range[0]) return std::nullopt;
    if (about[0] < 0 || as_size(about[0]) >= kNodesOfElement.size()) return std::nullopt;
    const std::uint64_t nodes = kNodesOfElement[as_size(about[0])];
    std::uint64_t count = 0;
    if (nodes == 0 ||
        __builtin_mul_overflow(static_cast<std::uint64_t>(range[1] - range[0]) + 1, nodes, &count))
      return std::nullopt;
    return count;
  }
  if (kind != "GridCoordinates_t" && kind != "FlowSolution_t") return std::nullopt;
  for (const char* const other : {"/Rind", "/PointList", "/PointRange"}) {
    if (file.has(group + other)) return std::nullopt;
  }
  const std::string place = file.has(group + "/GridLocation") ? file.word(group + "/GridLocation") : "Vertex";
  if (place != "Vertex" && place != "CellCenter") return std::nullopt;
  return size_of_zone(file, above(group), place == "CellCenter");
}

herr_t check_node(hid_t, const char* name, const H5O_info_t* about, void* data) {
  auto& walk = *static_cast<Walk*>(data);
  const std::string node(name);
  if (about->type != H5O_TYPE_GROUP || node.find('/') == std::string::npos ||
      walk.file.label(node) != "DataArray_t")
    return 0;
  const auto wanted = due(walk.file, node);
  const std::uint64_t found = wanted ? walk.file.count(node) : 0;
  if (!wanted || found == *wanted) return 0;
  walk.node = node;
  walk.problem = "has " + std::to_string(found) + " numbers, expected " + std::to_string(*wanted);
  return 1;
}

}  // namespace

void check_cgns(const std::string& file) {
  const CgnsFile opened(file);
  if (opened.id() < 0) return;
  Walk walk{.file = opened, .node = {}, .problem = {}};
  H5Ovisit(opened.id(), H5_INDEX_NAME, H5_ITER_NATIVE, check_node, &walk);
  if (!walk.problem.empty())
    throw input_error({file, "'" + walk.node + "'", walk.problem, "", "the file may be damaged"});
}

}  // namespace palpate
