#include "common/field/cells/constant_cells.h"

#include <algorithm>
#include <array>
#include <span>
#include <unordered_map>
#include <utility>

#include "common/base/index.h"

namespace palpate {
namespace {

constexpr std::uint8_t kHexahedron = 12, kPolyhedron = 42;  // of VTK's file format

/// Points along the axes; 0 where the block is unstructured.
Index3 points_along(const DataSet& block) {
  if (const auto* uniform = std::get_if<UniformTopology>(&block.topology)) return uniform->points;
  if (const auto* structured = std::get_if<StructuredTopology>(&block.topology)) return structured->points;
  const auto* lines = std::get_if<RectilinearTopology>(&block.topology);
  if (lines == nullptr) return Index3{0};
  return {static_cast<int>(lines->coordinates[0].size()), static_cast<int>(lines->coordinates[1].size()),
          static_cast<int>(lines->coordinates[2].size())};
}

Vec3 tuple_of(const DataArray& array, std::size_t i) {
  return {array.at(i, 0), array.at(i, 1), array.at(i, 2)};
}

Vec3 position_of(const DataSet& block, std::size_t point) {
  if (const auto* mesh = std::get_if<UnstructuredTopology>(&block.topology))
    return tuple_of(mesh->positions, point);
  if (const auto* grid = std::get_if<StructuredTopology>(&block.topology))
    return tuple_of(grid->positions, point);
  const Index3 n = points_along(block);
  const auto x = as_size(n.x), y = as_size(n.y);
  const std::array<std::size_t, 3> at{point % x, point / x % y, point / x / y};
  if (const auto* uniform = std::get_if<UniformTopology>(&block.topology)) {
    return uniform->origin + uniform->axes * Vec3{static_cast<double>(at[0]), static_cast<double>(at[1]),
                                                  static_cast<double>(at[2])};
  }
  const auto& lines = std::get<RectilinearTopology>(block.topology).coordinates;
  return {lines[0][at[0]], lines[1][at[1]], lines[2][at[2]]};
}

/// Calls `body(cell, type, points)` with the points of each cell; those of a polyhedron are its face stream.
template <class Body>
void each_cell(const DataSet& block, const Body& body) {
  if (const auto* mesh = std::get_if<UnstructuredTopology>(&block.topology)) {
    for (std::size_t c = 0; c < mesh->types.size(); ++c) {
      const auto begin = as_size(mesh->offsets[c]), end = as_size(mesh->offsets[c + 1]);
      body(c, mesh->types[c], std::span(mesh->connectivity).subspan(begin, end - begin));
    }
    return;
  }
  const Index3 n = points_along(block);
  std::size_t cell = 0;
  for (int k = 0; k + 1 < n.z; ++k) {
    for (int j = 0; j + 1 < n.y; ++j) {
      for (int i = 0; i + 1 < n.x; ++i, ++cell) {
        const std::int64_t first = i + std::int64_t{n.x} * (j + std::int64_t{n.y} * k);
        const std::int64_t up = std::int64_t{n.x} * n.y;
        const std::array<std::int64_t, 8> points{
            first,      first + 1,      first + 1 + n.x,      first + n.x,
            first + up, first + up + 1, first + up + 1 + n.x, first + up + n.x};
        body(cell, kHexahedron, std::span<const std::int64_t>(points));
      }
    }
  }
}

DataSet with_own_points(const DataSet& block, const std::vector<const DataArray*>& arrays) {
  UnstructuredTopology mesh;
  mesh.offsets.push_back(0);
  std::vector<double> positions;
  std::vector<std::vector<double>> values(arrays.size());
  DataSet out;
  out.name = block.name;
  std::unordered_map<std::int64_t, std::int64_t> own;
  each_cell(block, [&](std::size_t cell, std::uint8_t type, std::span<const std::int64_t> points) {
    if (!block.hidden_cells.empty() && block.hidden_cells[cell] != 0) return;
    own.clear();
    const auto add = [&](std::int64_t point) {
      const auto [found, fresh] = own.try_emplace(point, static_cast<std::int64_t>(positions.size() / 3));
      mesh.connectivity.push_back(found->second);
      if (!fresh) return;
      const Vec3 x = position_of(block, as_size(point));
      positions.insert(positions.end(), {x.x, x.y, x.z});
      if (!block.visible.empty()) out.visible.push_back(block.visible[as_size(point)]);
      for (std::size_t a = 0; a < arrays.size(); ++a) {
        for (int c = 0; c < arrays[a]->components; ++c) values[a].push_back(arrays[a]->at(cell, c));
      }
    };
    if (type == kPolyhedron) {
      mesh.connectivity.push_back(points[0]);
      for (std::size_t at = 1; at < points.size();) {
        const auto count = std::min(as_size(points[at]), points.size() - at - 1);
        mesh.connectivity.push_back(points[at]);
        for (std::size_t i = 0; i < count; ++i) add(points[at + 1 + i]);
        at += 1 + count;
      }
    } else {
      for (const std::int64_t point : points) add(point);
    }
    mesh.types.push_back(type);
    mesh.offsets.push_back(static_cast<std::int64_t>(mesh.connectivity.size()));
  });
  mesh.positions = make_array("positions", Association::kPoint, 3, std::span<const double>(positions));
  out.topology = std::move(mesh);
  for (std::size_t a = 0; a < arrays.size(); ++a) {
    out.arrays.push_back(make_array(arrays[a]->name, Association::kPoint, arrays[a]->components,
                                    std::span<const double>(values[a])));
  }
  return out;
}

}  // namespace

ConstantCells constant_cells(const std::vector<DataSet>& blocks, const VectorChoice& choice) {
  ConstantCells out;
  out.choice = choice;
  out.choice.association = Association::kPoint;
  for (const DataSet& block : blocks) {
    std::vector<const DataArray*> arrays;
    for (const std::string& name : choice.arrays) {
      if (const DataArray* array = block.find(name, Association::kCell)) arrays.push_back(array);
    }
    const bool whole = arrays.size() == choice.arrays.size();
    out.blocks.push_back(whole ? with_own_points(block, arrays) : block);
  }
  return out;
}

}  // namespace palpate
