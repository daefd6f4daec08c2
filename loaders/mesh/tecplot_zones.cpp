#include "loaders/mesh/tecplot_zones.h"

#include <array>
#include <initializer_list>
#include <limits>
#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/load/step_times.h"

namespace palpate {
namespace {

/// A brick with corners that coincide, as wedges, pyramids and tetrahedra are written.
void add_brick(CellList& cells, const std::int64_t* p) {
  const auto cell = [&](std::uint8_t type, std::initializer_list<int> corners) {
    std::array<std::int64_t, 8> points{};
    std::size_t count = 0;
    for (const int corner : corners) points[count++] = p[corner];
    cells.add(type, points.data(), count);
  };
  const bool top_is_point = p[4] == p[5] && p[5] == p[6] && p[6] == p[7];
  if (top_is_point && p[2] == p[3]) {
    cell(10, {0, 1, 2, 4});
  } else if (top_is_point) {
    cell(14, {0, 1, 2, 3, 4});
  } else if (p[2] == p[3] && p[6] == p[7]) {
    cell(13, {0, 1, 2, 4, 5, 6});
  } else {
    cell(12, {0, 1, 2, 3, 4, 5, 6, 7});
  }
}

/// The variables that are coordinates.
std::array<std::size_t, 3> coordinates(TecplotContent& content, const std::string& file) {
  std::array<std::size_t, 3> out{0, 1, 2};
  int found = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string letter(1, "xyz"[axis]);
    for (std::size_t v = content.variables.size(); v-- > 0;) {
      const std::string name = lowered(content.variables[v]);
      const bool own = name == letter || name.substr(0, 2) == letter + " " ||
                       name.substr(0, 2) == letter + "(" || name.substr(0, 2) == letter + "[" ||
                       name.substr(0, 2) == letter + "," || name == "coordinate" + letter ||
                       name == letter + "-coordinate" || name == letter + "_coordinate";
      if (!own) continue;
      out[axis] = v;
      found |= 1 << axis;
    }
  }
  if (content.variables.size() < 3) {
    throw input_error({file, "", "has " + counted(content.variables.size(), "variable"),
                       "three coordinates and values", ""});
  }
  if (found != 7) {
    out = {0, 1, 2};
    content.notes.insert("the first three variables, " + content.variables[0] + ", " + content.variables[1] +
                         " and " + content.variables[2] + ", are taken for the coordinates");
  }
  return out;
}

DataSet block_of(const TecplotZone& zone, const std::vector<std::string>& variables,
                 const std::array<std::size_t, 3>& xyz, const std::string& file) {
  const std::size_t nodes = zone.node_count();
  std::vector<double> positions(3 * nodes);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::vector<double>& from = zone.values[xyz[axis]];
    if (from.size() != nodes)
      throw input_error(
          {file, zone.name, "has no coordinate " + variables[xyz[axis]] + " of its points", "", ""});
    for (std::size_t n = 0; n < nodes; ++n) positions[3 * n + axis] = from[n];
  }
  DataSet block;
  block.name = zone.name;
  const DataArray placed = mesh_array("positions", Association::kPoint, 3, positions);
  if (zone.elements) {
    UnstructuredTopology mesh;
    mesh.positions = placed;
    CellList cells;
    for (std::size_t c = 0; c < zone.cell_count() && zone.type != 0; ++c) {
      const std::int64_t* const corners =
          zone.connectivity.data() + c * static_cast<std::size_t>(zone.corners);
      if (zone.type == 12) {
        add_brick(cells, corners);
      } else {
        cells.add(zone.type, corners, static_cast<std::size_t>(zone.corners));
      }
    }
    cells.take(mesh);
    block.topology = std::move(mesh);
  } else {
    block.topology = StructuredTopology{
        .points = {static_cast<int>(zone.i), static_cast<int>(zone.j), static_cast<int>(zone.k)},
        .positions = placed};
  }
  for (std::size_t v = 0; v < variables.size(); ++v) {
    if (v == xyz[0] || v == xyz[1] || v == xyz[2] || zone.values[v].empty()) continue;
    block.arrays.push_back(mesh_array(variables[v],
                                      zone.of_cells.count(v) > 0 ? Association::kCell : Association::kPoint,
                                      1, zone.values[v]));
  }
  return block;
}

}  // namespace

MeshFile meshes_of(TecplotContent content, const std::string& file, std::size_t budget) {
  if (content.zones.empty())
    throw input_error({file, "", "has no zone", "data", "the file may be truncated"});
  const auto xyz = coordinates(content, file);
  std::vector<double> times;
  for (const TecplotZone& zone : content.zones) {
    if (zone.time) times.push_back(*zone.time);
  }
  times = joined_times(std::move(times));
  for (std::size_t z = 0, t = 0; z < content.zones.size(); ++z) {
    if (content.zones[z].time) content.zones[z].time = times[t++];
  }
  MeshFile out;
  std::map<double, std::vector<DataSet>> by_time;
  std::vector<DataSet> always;
  std::size_t flat = 0;
  for (const TecplotZone& zone : content.zones) {
    const bool volume = zone.elements ? zone.type != 0 : std::min({zone.i, zone.j, zone.k}) > 1;
    constexpr std::int64_t kMostPoints = std::numeric_limits<int>::max();
    if (std::max({zone.i, zone.j, zone.k}) > kMostPoints)
      throw input_error({file, zone.name, "has too many points", "2^31 at most along an axis"});
    if (!volume) {
      ++flat;
      continue;
    }
    (zone.time ? by_time[*zone.time] : always).push_back(block_of(zone, content.variables, xyz, file));
  }
  if (by_time.empty() && always.empty()) {
    throw input_error({file, "", "holds points, lines or surfaces only (" + counted(flat, "zone") + ")",
                       "a zone of a volume", ""});
  }
  if (flat > 0) content.notes.insert(counted(flat, "zone") + " of points, lines or surfaces left out");
  if (by_time.empty()) {
    out.steps.push_back(std::move(always));
  } else {
    std::size_t repeated = 0;
    for (const DataSet& block : always) {
      if (const auto* mesh = std::get_if<UnstructuredTopology>(&block.topology))
        repeated += mesh->connectivity.size();
    }
    for (auto& [time, blocks] : by_time) {
      if (repeated > budget)
        throw input_error(
            {file, "", "repeats many elements that stand at all times", "as many as the file is long"});
      budget -= repeated;
      out.times.push_back(time);
      out.steps.push_back(always);
      out.steps.back().insert(out.steps.back().end(), blocks.begin(), blocks.end());
    }
  }
  out.notes.assign(content.notes.begin(), content.notes.end());
  return out;
}

}  // namespace palpate
