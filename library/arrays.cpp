// Fields that are made of arrays which somebody else owns.
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/base/index.h"
#include "common/field/data_set.h"
#include "library/access.h"

namespace palpate::api {
namespace {

template <class Number>
DataArray array_of(const char* name, int components, std::span<const Number> values,
                   std::shared_ptr<const void> owner) {
  return {.name = name,
          .association = Association::kPoint,
          .components = components,
          .type = std::is_same_v<Number, float> ? ScalarType::kFloat32 : ScalarType::kFloat64,
          .tuples = values.size() / as_size(components),
          .bytes = std::as_bytes(values),
          .owner = std::move(owner),
          .sparse = nullptr};
}

template <class Topology>
std::vector<DataSet> block_of(Topology topology, DataArray values) {
  std::vector<DataSet> blocks(1);
  blocks.front().topology = std::move(topology);
  blocks.front().arrays.push_back(std::move(values));
  return blocks;
}

Field field_of(const std::vector<DataSet>& blocks) {
  const VectorChoice choice{VectorChoice::Kind::kArray, Association::kPoint, {"values"}, "values"};
  return Access::field(make_vector_field(blocks, choice, "values"));
}

Scalar scalar_of(const std::vector<DataSet>& blocks) {
  return Access::scalar(make_scalar_field(blocks, ScalarChoice{.array = "values"}, "values"));
}

void check_count(std::size_t found, std::size_t expected, int components) {
  if (found == expected) return;
  throw input_error(
      {.file = "values",
       .place = {},
       .found = std::to_string(found) + " numbers",
       .expected = std::to_string(expected) + ", " + std::to_string(components) + " for each point",
       .remedy = {}});
}

/// @param numbers that there are, `components` for each point. @throws as input_error().
UniformTopology lattice(const std::array<std::int64_t, 3>& points, const Point& origin, const Point& spacing,
                        std::size_t numbers, int components) {
  UniformTopology grid;
  std::size_t count = 1;
  for (int k = 0; k < 3; ++k) {
    const std::int64_t n = points[as_size(k)];
    const bool fits = n > 0 && count <= numbers / as_size(n);
    // More points than there are numbers: the product is not needed, and may be beyond any integer.
    count = fits ? count * as_size(n) : 0;
    if (count == 0) break;
    grid.points[k] = n;
    grid.axes[k] = Vec3(0.0);
    grid.axes[k][k] = spacing[as_size(k)];
  }
  if (count == 0) {
    throw input_error({.file = "values",
                       .place = {},
                       .found = std::to_string(numbers) + " numbers",
                       .expected = std::to_string(components) + " for each of " + std::to_string(points[0]) +
                                   " x " + std::to_string(points[1]) + " x " + std::to_string(points[2]) +
                                   " points",
                       .remedy = {}});
  }
  check_count(numbers, as_size(components) * count, components);
  grid.origin = vec_of(origin);
  return grid;
}

template <class Shared>
Field vectors(const std::array<std::int64_t, 3>& points, const Point& origin, const Point& spacing,
              const Shared& shared) {
  return guarded([&] {
    return field_of(block_of(lattice(points, origin, spacing, shared.values.size(), 3),
                             array_of("values", 3, shared.values, shared.owner)));
  });
}

template <class Shared>
Scalar scalars(const std::array<std::int64_t, 3>& points, const Point& origin, const Point& spacing,
               const Shared& shared) {
  return guarded([&] {
    return scalar_of(block_of(lattice(points, origin, spacing, shared.values.size(), 1),
                              array_of("values", 1, shared.values, shared.owner)));
  });
}

}  // namespace

Field Field::uniform(const std::array<std::int64_t, 3>& points, const Point& origin, const Point& spacing,
                     const SharedDoubles& values) {
  return vectors(points, origin, spacing, values);
}

Field Field::uniform(const std::array<std::int64_t, 3>& points, const Point& origin, const Point& spacing,
                     const SharedFloats& values) {
  return vectors(points, origin, spacing, values);
}

Scalar Scalar::uniform(const std::array<std::int64_t, 3>& points, const Point& origin, const Point& spacing,
                       const SharedDoubles& values) {
  return scalars(points, origin, spacing, values);
}

Scalar Scalar::uniform(const std::array<std::int64_t, 3>& points, const Point& origin, const Point& spacing,
                       const SharedFloats& values) {
  return scalars(points, origin, spacing, values);
}

UnstructuredTopology tetrahedra_of(const SharedDoubles& points, std::span<const std::int64_t> cells) {
  constexpr std::uint8_t kTetrahedron = 10;
  if (points.values.size() % 3 != 0) {
    throw input_error({.file = "points",
                       .place = {},
                       .found = std::to_string(points.values.size()) + " numbers",
                       .expected = "three for each point",
                       .remedy = {}});
  }
  const auto count = static_cast<std::int64_t>(points.values.size() / 3);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i] >= 0 && cells[i] < count) continue;
    throw input_error({.file = "cells",
                       .place = "cell " + std::to_string(i / 4),
                       .found = "point " + std::to_string(cells[i]),
                       .expected = "0 to " + std::to_string(count - 1),
                       .remedy = {}});
  }
  if (cells.size() % 4 != 0 || cells.empty()) {
    throw input_error({.file = "cells",
                       .place = {},
                       .found = std::to_string(cells.size()) + " numbers",
                       .expected = "four for each cell",
                       .remedy = {}});
  }
  UnstructuredTopology mesh{.positions = array_of("points", 3, points.values, points.owner),
                            .types = std::vector<std::uint8_t>(cells.size() / 4, kTetrahedron),
                            .offsets = {},
                            .connectivity = {cells.begin(), cells.end()}};
  for (std::size_t c = 0; c <= cells.size() / 4; ++c)
    mesh.offsets.push_back(static_cast<std::int64_t>(4 * c));
  return mesh;
}

Field Field::tetrahedra(const SharedDoubles& points, std::span<const std::int64_t> cells,
                        const SharedDoubles& values) {
  return guarded([&] {
    check_count(values.values.size(), points.values.size(), 3);
    return field_of(
        block_of(tetrahedra_of(points, cells), array_of("values", 3, values.values, values.owner)));
  });
}

}  // namespace palpate::api
