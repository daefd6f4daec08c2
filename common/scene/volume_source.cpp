#include "common/scene/volume_source.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"

namespace palpate {
namespace {

/// The number that `choice` takes of every tuple, as an array of its own.
DataArray single_component(const DataArray& array, int component) {
  std::vector<float> values(array.tuples);
  for (std::size_t t = 0; t < array.tuples; ++t) {
    double value = 0.0;
    if (component == ScalarChoice::kMagnitude) {
      for (int c = 0; c < array.components; ++c) value = std::hypot(value, array.at(t, c));
    } else {
      value = array.at(t, component);
    }
    values[t] = static_cast<float>(value);
  }
  return make_array(array.name, array.association, 1, values);
}

/// Of a step of a lattice: what programs leave of digits.
constexpr double kRounding = 1e-3;

std::optional<UniformTopology> lattice_of(const RectilinearTopology& grid) {
  UniformTopology lattice;
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<double>& x = grid.coordinates[as_size(axis)];
    if (x.empty()) return std::nullopt;
    const double step = x.size() > 1 ? (x.back() - x.front()) / static_cast<double>(x.size() - 1) : 1.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!(std::abs(x.front() + step * static_cast<double>(i) - x[i]) <= kRounding * std::abs(step)))
        return std::nullopt;
    }
    lattice.points[axis] = static_cast<int>(x.size());
    lattice.origin[axis] = x.front();
    lattice.axes[axis] = Vec3{0.0};
    lattice.axes[axis][axis] = step;
  }
  return lattice;
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

}  // namespace

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
  const auto* topology =
      blocks.size() == 1 ? std::get_if<UniformTopology>(&blocks.front().topology) : nullptr;
  if (topology == nullptr) {
    throw input_error({file, "", "is not one uniform grid", "one: images, and grids whose points lie evenly",
                       "make an image of it, by 'Resample To Image' in ParaView for one"});
  }
  const DataSet& block = blocks.front();
  const DataArray* array = block.find(choice.array, choice.association);
  if (array == nullptr) throw input_error({file, "", "has no array '" + choice.array + "'"});

  DataSet source;
  source.name = block.name;
  UniformTopology place = *topology;
  DataArray values = array->components == 1 ? *array : single_component(*array, choice.component);
  if (choice.association == Association::kCell) {
    for (int axis = 0; axis < 3; ++axis) {
      // A flat grid has its cells in its plane.
      if (place.points[axis] < 2) continue;
      place.origin += 0.5 * place.axes[axis];
      --place.points[axis];
    }
    values.association = Association::kPoint;
  } else {
    source.visible = block.visible;
    source.hidden_cells = block.hidden_cells;
  }
  source.topology = place;
  source.arrays.push_back(std::move(values));
  return source;
}

}  // namespace palpate
