#include "loaders/hdf/cgns_check.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <hdf5.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "loaders/hdf/cgns_file.h"
#include "loaders/hdf/cgns_shape.h"

namespace palpate {
namespace {

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
  if (kind != "GridCoordinates_t" && kind != "FlowSolution_t") return std::nullopt;
  for (const char* const other : {"/Rind", "/PointList", "/PointRange"}) {
    if (file.has(group + other)) return std::nullopt;
  }
  const std::string place = file.has(group + "/GridLocation") ? file.word(group + "/GridLocation") : "Vertex";
  if (place != "Vertex" && place != "CellCenter") return std::nullopt;
  return size_of_zone(file, above(group), place == "CellCenter");
}

/// Whether a word of a node has room where libcgns reads it, which does not ask.
bool has_room(hid_t file, const std::string& node, const char* word, std::size_t room) {
  if (H5Aexists_by_name(file, node.c_str(), word, H5P_DEFAULT) <= 0) return true;
  const hid_t attribute = H5Aopen_by_name(file, node.c_str(), word, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t type = H5Aget_type(attribute), space = H5Aget_space(attribute);
  const bool fits = H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) <= 0 &&
                    H5Tget_size(type) <= room && H5Sget_simple_extent_npoints(space) == 1;
  H5Sclose(space);
  H5Tclose(type);
  H5Aclose(attribute);
  return fits;
}

herr_t check_node(hid_t file, const char* name, const H5O_info_t* about, void* data) {
  auto& walk = *static_cast<Walk*>(data);
  const std::string node(name);
  if (about->type == H5O_TYPE_GROUP) {
    // CGNS File Mapping Manual, "HDF5": names and labels of 32 characters, types of 2, and a zero behind.
    constexpr std::array<std::pair<const char*, std::size_t>, 3> kWords{
        {{"name", 33}, {"label", 33}, {"type", 3}}};
    for (const auto& [word, room] : kWords) {
      if (has_room(file, node, word, room)) continue;
      walk.node = node;
      walk.problem =
          std::string("has a ") + word + " that is no text of " + std::to_string(room - 1) + " characters";
      return 1;
    }
  }
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

// CGNS SIDS, "Data-name identifiers": the coordinates of other systems.
constexpr std::array kCurved{"CoordinateR", "CoordinateTheta", "CoordinatePhi"};

/// Whether elements are of volumes: of three dimensions, or faces and cells without a kind.
bool is_volume(std::int64_t kind) {
  // ElementType_t: lines and surfaces stand between volumes of two, three and four orders.
  constexpr std::int64_t kFirst = 10, kBar4 = 24, kQuad16 = 28, kBar5 = 40, kQuad25 = 44;
  return kind >= kFirst && (kind < kBar4 || kind > kQuad16) && (kind < kBar5 || kind > kQuad25);
}

struct Zone {
  std::string node;
  bool of_cells = false;              ///< it has values of cells
  std::map<std::string, int> arrays;  ///< by place and name, how many solutions have them
  bool has_pointers = false;          ///< which say what belongs to which time
  // VTK's reader takes as cells what has a number up to that of the zone's cells.
  bool has_volume = false, border_within = false, volume_behind = false;
};

void look_at_solution(const CgnsFile& file, const std::string& node, Zone& zone) {
  const std::string place = file.has(node + "/GridLocation") ? file.word(node + "/GridLocation") : "Vertex";
  zone.of_cells = zone.of_cells || place == "CellCenter";
  for (const std::string& array : file.children(node)) {
    if (file.label(node + "/" + array) == "DataArray_t") ++zone.arrays[place + "/" + array];
  }
}

void look_at_elements(const CgnsFile& file, const std::string& node, std::uint64_t cells, Zone& zone) {
  const std::vector<std::int64_t> about = file.numbers(node), range = file.numbers(node + "/ElementRange");
  if (about.empty() || range.empty()) return;
  constexpr std::int64_t kPolygons = 22, kPolyhedra = 23;  // in lists of their own
  const bool volume = is_volume(about[0]), within = std::cmp_less_equal(range[0], cells);
  zone.has_volume = zone.has_volume || volume;
  zone.border_within = zone.border_within || (!volume && within);
  zone.volume_behind =
      zone.volume_behind || (volume && !within && about[0] != kPolygons && about[0] != kPolyhedra);
}

// @throws Error (bad input).
Zone look_at_zone(const CgnsFile& file, const std::string& name, const std::string& node) {
  Zone zone{.node = node, .arrays = {}};
  const std::uint64_t cells = size_of_zone(file, node, true).value_or(0);
  for (const std::string& child : file.children(node)) {
    const std::string at = node + "/" + child, kind = file.label(at);
    if (kind == "FlowSolution_t") look_at_solution(file, at, zone);
    if (kind == "Elements_t") look_at_elements(file, at, cells, zone);
    if (kind == "ZoneIterativeData_t" && file.has(at + "/FlowSolutionPointers")) zone.has_pointers = true;
    if (kind != "GridCoordinates_t") continue;
    for (const char* const curved : kCurved) {
      if (!file.has(at + "/" + curved)) continue;
      throw input_error({name, "'" + at + "'", std::string("has ") + curved,
                         "Cartesian coordinates: CoordinateX, CoordinateY and CoordinateZ",
                         "convert them where the file was written"});
    }
  }
  if (zone.volume_behind) {
    throw input_error(
        {name, "'" + node + "'",
         "numbers elements of its volume behind as many as it has cells, which VTK's reader leaves "
         "out",
         "volume elements first", "write the elements in the other order"});
  }
  if (zone.of_cells && zone.has_volume && zone.border_within) {
    throw input_error(
        {name, "'" + node + "'",
         "numbers elements of its border before those of its volume, behind which VTK's reader loses values "
         "of cells",
         "volume elements first", "write the values at vertices, or the elements in the other order"});
  }
  return zone;
}

std::string unit_of(const CgnsFile& file, const std::string& base) {
  constexpr std::size_t kLength = 32;
  const std::string units = base + "/DimensionalUnits";
  const std::string all = file.word(units);  // five names of 32 characters
  if (all.size() < 2 * kLength) return {};
  static const std::map<std::string, std::string> kShort{
      {"Meter", "m"}, {"Centimeter", "cm"}, {"Millimeter", "mm"}, {"Foot", "ft"}, {"Inch", "in"}};
  const auto unit = kShort.find(std::string(trimmed(std::string_view(all).substr(kLength, kLength))));
  return unit == kShort.end() ? std::string() : "coordinates in " + unit->second;
}

/// @returns the unit of the bases, where they have one.
std::string look_at_bases(const CgnsFile& opened, const std::string& file, std::vector<std::string>& notes) {
  std::set<std::string> units;
  for (const std::string& base : opened.children("/")) {
    if (opened.label("/" + base) != "CGNSBase_t") continue;
    units.insert(unit_of(opened, "/" + base));
    for (const std::string& child : opened.children("/" + base)) {
      const std::string node = "/" + base + "/" + child;
      if (opened.label(node) != "Zone_t") continue;
      const Zone zone = look_at_zone(opened, file, node);
      const auto several =
          std::ranges::find_if(zone.arrays, [](const auto& array) { return array.second > 1; });
      if (zone.has_pointers || several == zone.arrays.end()) continue;
      notes.push_back(
          "WARNING: '" + printable(node.substr(1)) + "' has " +
          printable(several->first.substr(several->first.find('/') + 1)) + " in " +
          std::to_string(several->second) +
          " solutions, and no FlowSolutionPointers say at which time which is: the first one is shown at "
          "all times");
    }
  }
  if (units.size() > 1)
    notes.emplace_back("WARNING: the bases of the file have different units, of which none is heeded");
  return units.size() == 1 ? *units.begin() : std::string();
}

}  // namespace

std::string check_cgns(const std::string& file, std::vector<std::string>& notes) {
  const CgnsFile opened(file);
  if (opened.id() < 0) return {};
  if (const CgnsProblem wrong = find_cgns_problem(opened); !wrong.problem.empty())
    throw input_error({file, "'" + wrong.node + "'", wrong.problem, "", "the file may be damaged"});
  Walk walk{.file = opened, .node = {}, .problem = {}};
  H5Ovisit(opened.id(), H5_INDEX_NAME, H5_ITER_NATIVE, check_node, &walk);
  if (!walk.problem.empty())
    throw input_error({file, "'" + walk.node + "'", walk.problem, "", "the file may be damaged"});
  return look_at_bases(opened, file, notes);
}

}  // namespace palpate
