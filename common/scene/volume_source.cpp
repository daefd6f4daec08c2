#include "common/scene/volume_source.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/field/grid/lattice_lines.h"

namespace palpate {
namespace {

DataArray magnitudes_of(const DataArray& array) {
  std::vector<float> values(array.tuples);
  for (std::size_t t = 0; t < array.tuples; ++t) {
    double value = 0.0;
    for (int c = 0; c < array.components; ++c) value = std::hypot(value, array.at(t, c));
    values[t] = static_cast<float>(value);
  }
  return make_array(array.name, array.association, 1, values);
}

/// The number that `component` counts of every tuple, in its type.
DataArray component_of(const DataArray& array, int component) {
  const std::size_t size = byte_size(array.type), stride = size * as_size(array.components);
  auto bytes = std::make_shared<std::vector<std::byte>>(array.tuples * size);
  for (std::size_t t = 0; t < array.tuples; ++t)
    std::memcpy(bytes->data() + t * size, array.bytes.data() + t * stride + as_size(component) * size, size);
  DataArray taken = array;
  taken.components = 1;
  taken.bytes = std::as_const(*bytes);
  taken.owner = std::move(bytes);
  return taken;
}

/// What `component` takes of every tuple, as an array of its own. @pre not sparse: such numbers are single.
DataArray single_component(const DataArray& array, int component) {
  return component == ScalarChoice::kMagnitude ? magnitudes_of(array) : component_of(array, component);
}

/// Of a step of a lattice: what programs leave of digits.
constexpr double kRounding = 1e-3;

std::optional<UniformTopology> lattice_of(const RectilinearTopology& grid) {
  const UnevenLattice lattice = uneven_lattice(grid, kRounding);
  const Index3& n = lattice.mean.points;
  if (lattice.lines || std::min({n.x, n.y, n.z}) < 1) return std::nullopt;
  return lattice.mean;
}

std::optional<UniformTopology> lattice_of(const StructuredTopology& grid) {
  const auto at = [&grid](int i, int j, int k) {
    const std::size_t p =
        as_size(i) + as_size(grid.points.x) * (as_size(j) + as_size(grid.points.y) * as_size(k));
    return Vec3{grid.positions.at(p, 0), grid.positions.at(p, 1), grid.positions.at(p, 2)};
  };
  const Index3 last = grid.points - 1;
  if (std::min({last.x, last.y, last.z}) < 1) return std::nullopt;  // a sheet has no third axis
  UniformTopology lattice{.points = grid.points, .origin = at(0, 0, 0)};
  lattice.axes[0] = (at(last.x, 0, 0) - lattice.origin) / static_cast<double>(last.x);
  lattice.axes[1] = (at(0, last.y, 0) - lattice.origin) / static_cast<double>(last.y);
  lattice.axes[2] = (at(0, 0, last.z) - lattice.origin) / static_cast<double>(last.z);
  const double step =
      std::min({glm::length(lattice.axes[0]), glm::length(lattice.axes[1]), glm::length(lattice.axes[2])});
  const double volume = std::abs(glm::determinant(lattice.axes));
  if (!(volume > kRounding * step * step * step)) return std::nullopt;
  for (int k = 0; k <= last.z; ++k) {
    for (int j = 0; j <= last.y; ++j) {
      for (int i = 0; i <= last.x; ++i) {
        const Vec3 expected = lattice.origin + lattice.axes * Vec3(i, j, k);
        if (!(glm::distance(expected, at(i, j, k)) <= kRounding * step)) return std::nullopt;
      }
    }
  }
  return lattice;
}

/// An image whose cells have the values: these stand at the middles of the cells.
UniformTopology middles_of(UniformTopology place) {
  for (int axis = 0; axis < 3; ++axis) {
    // A flat grid has its cells in its plane.
    if (place.points[axis] < 2) continue;
    place.origin += 0.5 * place.axes[axis];
    --place.points[axis];
  }
  return place;
}

/// The same of a rectilinear grid. An axis of one cell keeps both of its ends, with the value of the cell at either.
RectilinearTopology middles_of(const RectilinearTopology& grid, DataArray& values,
                               std::vector<std::uint8_t>& visible) {
  RectilinearTopology place;
  Index3 cells{1}, points{1};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::vector<double>& x = grid.coordinates[axis];
    if (x.size() < 3) place.coordinates[axis] = x;
    for (std::size_t i = 1; x.size() >= 3 && i < x.size(); ++i)
      place.coordinates[axis].push_back(0.5 * (x[i - 1] + x[i]));
    const int a = static_cast<int>(axis);
    points[a] = static_cast<int>(place.coordinates[axis].size());
    cells[a] = x.size() == 2 ? 1 : points[a];
  }
  if (points == cells) return place;
  const std::size_t size = byte_size(values.type) * as_size(values.components);
  auto bytes = std::make_shared<std::vector<std::byte>>(count_of(points) * size);
  std::vector<std::uint8_t> seen(visible.empty() ? 0 : count_of(points));
  std::size_t to = 0;
  for (int k = 0; k < points.z; ++k) {
    for (int j = 0; j < points.y; ++j) {
      for (int i = 0; i < points.x; ++i, ++to) {
        const std::size_t from = index_in(cells, glm::min(Index3(i, j, k), cells - 1));
        std::memcpy(bytes->data() + to * size, values.bytes.data() + from * size, size);
        if (!seen.empty()) seen[to] = visible[from];
      }
    }
  }
  values.tuples = to;
  values.bytes = std::as_const(*bytes);
  values.owner = std::move(bytes);
  visible = std::move(seen);
  return place;
}

}  // namespace

bool is_one_lattice(const std::vector<DataSet>& blocks) {
  return blocks.size() == 1 && (std::holds_alternative<UniformTopology>(blocks.front().topology) ||
                                std::holds_alternative<RectilinearTopology>(blocks.front().topology));
}

void take_lattices(std::vector<DataSet>& blocks) {
  for (DataSet& block : blocks) {
    std::optional<UniformTopology> lattice;
    if (const auto* rectilinear = std::get_if<RectilinearTopology>(&block.topology))
      lattice = lattice_of(*rectilinear);
    if (const auto* structured = std::get_if<StructuredTopology>(&block.topology))
      lattice = lattice_of(*structured);
    if (lattice) block.topology = *lattice;
  }
}

DataSet volume_source(const std::vector<DataSet>& blocks, const ScalarChoice& choice,
                      const std::string& file) {
  if (!is_one_lattice(blocks)) {
    throw input_error({file, "", "is not one grid along straight axes", "an image, or a rectilinear grid",
                       "make an image of it, by 'Resample To Image' in ParaView for one"});
  }
  const DataSet& block = blocks.front();
  const DataArray* array = block.find(choice.array, choice.association);
  if (array == nullptr) throw input_error({file, "", "has no array '" + choice.array + "'"});

  DataSet source;
  source.name = block.name;
  DataArray values = array->components == 1 ? *array : single_component(*array, choice.component);
  if (choice.association == Association::kCell) {
    // What is hidden is no voxel.
    source.visible = block.hidden_cells;
    for (std::uint8_t& visible : source.visible) visible = visible == 0 ? 1 : 0;
    if (const auto* grid = std::get_if<RectilinearTopology>(&block.topology)) {
      source.topology = middles_of(*grid, values, source.visible);
    } else {
      source.topology = middles_of(std::get<UniformTopology>(block.topology));
    }
    values.association = Association::kPoint;
  } else {
    source.topology = block.topology;
    source.visible = block.visible;
    source.hidden_cells = block.hidden_cells;
  }
  source.arrays.push_back(std::move(values));
  return source;
}

}  // namespace palpate
