#include "common/load/volume_block.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include "common/base/index.h"
#include "common/field/cells/loose_points.h"
#include "common/field/grid/cell_faces.h"

namespace palpate {

Box sample_bounds(const UniformTopology& topology) noexcept {
  Box bounds;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vec3 index{0.0};
    for (int axis = 0; axis < 3; ++axis) {
      if ((corner >> static_cast<unsigned>(axis) & 1U) != 0) index[axis] = topology.points[axis] - 1;
    }
    bounds.include(topology.origin + topology.axes * index);
  }
  return bounds;
}

BlockInfo describe_image(const UniformTopology& topology, const ArrayInfo& array) {
  static constexpr std::array<const char*, 3> kAxes{"first", "second", "third"};
  BlockInfo block;
  block.grid = "uniform";
  block.points = topology.points;
  block.point_count = array.tuples;
  block.cell_count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    block.cell_count *= static_cast<std::uint64_t>(std::max(1, block.points[axis] - 1));
    if (block.points[axis] == 1) {
      block.not_volume = std::string("is flat (one sample along its ") + kAxes[as_size(axis)] +
                         " spatial axis), not a volume";
    }
  }
  block.bounds = sample_bounds(topology);
  block.arrays.push_back(array);
  return block;
}

bool is_flat_cell(std::uint8_t type) noexcept {
  constexpr std::array<std::uint8_t, 28> kFlat{0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  21, 22, 23, 28,
                                               30, 34, 35, 36, 60, 61, 62, 63, 68, 69, 70, 75, 76, 77};
  return std::ranges::find(kFlat, type) != kFlat.end();
}

BlockInfo describe_mesh(const DataSet& mesh) {
  BlockInfo block;
  block.name = mesh.name;
  block.grid = "unstructured";
  block.point_count = mesh.point_count();
  block.cell_count = mesh.cell_count();
  const auto& cells = std::get<UnstructuredTopology>(mesh.topology);
  if (!cells.types.empty() && std::ranges::all_of(cells.types, is_flat_cell))
    block.not_volume = kOnlyFlatCells;
  block.faces = block.not_volume.empty() && std::ranges::any_of(cells.types, is_surface);
  const DataArray& positions = cells.positions;
  const std::vector<std::uint8_t> used = points_of_cells(cells);
  for (std::size_t p = 0; p < positions.tuples; ++p) {
    if (used[p] != 0) block.bounds.include(Vec3(positions.at(p, 0), positions.at(p, 1), positions.at(p, 2)));
  }
  for (const DataArray& array : mesh.arrays)
    block.arrays.push_back({array.name, array.association, array.components, array.type, array.tuples});
  return block;
}

std::vector<DataSet> read_image(const UniformTopology& topology, const std::string& array,
                                const std::vector<std::string>& names,
                                const std::function<DataArray()>& values) {
  std::vector<DataSet> blocks(1);
  blocks.front().topology = topology;
  if (std::find(names.begin(), names.end(), array) == names.end()) return blocks;
  DataArray read = values();
  read.name = array;
  blocks.front().arrays.push_back(std::move(read));
  return blocks;
}

}  // namespace palpate
