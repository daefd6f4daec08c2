#include "lab/data/made_data.h"

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>
#include <utility>

#include "common/base/index.h"

namespace palpate {
namespace {

DataArray vectors(const std::string& name, const std::vector<Vec3>& values) {
  std::vector<double> numbers;
  numbers.reserve(3 * values.size());
  for (const Vec3& v : values) numbers.insert(numbers.end(), {v.x, v.y, v.z});
  return make_array(name, Association::kPoint, 3, std::span<const double>(numbers));
}

/// The array in doubles, each number through `change(tuple, value)`.
template <typename Change>
DataArray changed(const DataArray& array, const Change& change) {
  std::vector<double> numbers;
  numbers.reserve(array.tuples * as_size(array.components));
  for (std::size_t t = 0; t < array.tuples; ++t) {
    for (int c = 0; c < array.components; ++c) numbers.push_back(change(t, array.at(t, c)));
  }
  return make_array(array.name, array.association, array.components, std::span<const double>(numbers));
}

}  // namespace

FieldPtr made_field(DataSet data) {
  std::vector<DataSet> blocks;
  blocks.push_back(std::move(data));
  return make_vector_field(blocks, {.arrays = {"velocity"}, .label = "velocity"}, "made data");
}

std::vector<double> even_coordinates(int n) {
  std::vector<double> x;
  x.reserve(as_size(n));
  for (int i = 0; i < n; ++i) x.push_back(-1.0 + 2.0 * i / (n - 1));
  return x;
}

DataSet uniform_data(int n, const Box& bounds, const VectorFormula& velocity) {
  DataSet data;
  UniformTopology grid;
  grid.points = Index3{n, n, n};
  grid.origin = bounds.lower;
  const Vec3 step = bounds.size() / static_cast<double>(n - 1);
  grid.axes = Mat3{Vec3{step.x, 0, 0}, Vec3{0, step.y, 0}, Vec3{0, 0, step.z}};
  data.topology = grid;
  std::vector<Vec3> values;
  for (std::size_t p = 0; p < as_size(n) * as_size(n) * as_size(n); ++p) {
    values.push_back(velocity(point_position(data, p)));
  }
  data.arrays.push_back(vectors("velocity", values));
  return data;
}

DataSet rectilinear_data(const std::vector<double>& x, const std::vector<double>& y,
                         const std::vector<double>& z, const VectorFormula& velocity) {
  DataSet data;
  data.topology = RectilinearTopology{{x, y, z}};
  std::vector<Vec3> values;
  for (std::size_t p = 0; p < data.point_count(); ++p) values.push_back(velocity(point_position(data, p)));
  data.arrays.push_back(vectors("velocity", values));
  return data;
}

DataSet tetrahedral_data(const std::vector<double>& x, const std::vector<double>& y,
                         const std::vector<double>& z, const VectorFormula& velocity) {
  std::vector<Vec3> points;
  for (const double zk : z) {
    for (const double yj : y) {
      for (const double xi : x) points.emplace_back(xi, yj, zk);
    }
  }
  UnstructuredTopology mesh;
  mesh.positions = vectors("positions", points);
  // Each of the six orders of the axes is a path along three edges from the low to the high corner.
  constexpr std::array<std::array<int, 3>, 6> kOrders{
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  const std::array<std::int64_t, 3> stride{1, static_cast<std::int64_t>(x.size()),
                                           static_cast<std::int64_t>(x.size() * y.size())};
  constexpr std::uint8_t kTetrahedron = 10;
  for (std::size_t k = 0; k + 1 < z.size(); ++k) {
    for (std::size_t j = 0; j + 1 < y.size(); ++j) {
      for (std::size_t i = 0; i + 1 < x.size(); ++i) {
        for (const auto& order : kOrders) {
          auto corner = static_cast<std::int64_t>(i) + stride[1] * static_cast<std::int64_t>(j) +
                        stride[2] * static_cast<std::int64_t>(k);
          mesh.offsets.push_back(static_cast<std::int64_t>(mesh.connectivity.size()));
          mesh.types.push_back(kTetrahedron);
          mesh.connectivity.push_back(corner);
          for (const int axis : order) mesh.connectivity.push_back(corner += stride[as_size(axis)]);
        }
      }
    }
  }
  mesh.offsets.push_back(static_cast<std::int64_t>(mesh.connectivity.size()));

  DataSet data;
  data.topology = std::move(mesh);
  std::vector<Vec3> values;
  values.reserve(points.size());
  for (const Vec3& p : points) values.push_back(velocity(p));
  data.arrays.push_back(vectors("velocity", values));
  return data;
}

DataSet scaled_data(const DataSet& data, double length, double value) {
  DataSet scaled = data;
  const auto scale_positions = [length](const DataArray& positions) {
    return changed(positions, [length](std::size_t, double x) { return x * length; });
  };
  std::visit(
      [&](auto& grid) {
        using Grid = std::decay_t<decltype(grid)>;
        if constexpr (std::is_same_v<Grid, UniformTopology>) {
          grid.origin *= length;
          grid.axes *= length;
        } else if constexpr (std::is_same_v<Grid, RectilinearTopology>) {
          for (auto& axis : grid.coordinates) {
            for (double& x : axis) x *= length;
          }
        } else {
          grid.positions = scale_positions(grid.positions);
        }
      },
      scaled.topology);
  for (DataArray& array : scaled.arrays) {
    array = changed(array, [value](std::size_t, double v) { return v * value; });
  }
  return scaled;
}

DataSet holed_data(const DataSet& data, const Vec3& center, double radius) {
  DataSet holed = data;
  for (DataArray& array : holed.arrays) {
    if (array.association != Association::kPoint) continue;
    array = changed(array, [&](std::size_t point, double value) {
      const bool inside = glm::distance(point_position(data, point), center) < radius;
      return inside ? std::numeric_limits<double>::quiet_NaN() : value;
    });
  }
  return holed;
}

Vec3 point_position(const DataSet& data, std::size_t point) {
  const auto index_in = [point](std::size_t nx, std::size_t ny) {
    return std::array<std::size_t, 3>{point % nx, point / nx % ny, point / nx / ny};
  };
  return std::visit(
      [&](const auto& grid) {
        using Grid = std::decay_t<decltype(grid)>;
        if constexpr (std::is_same_v<Grid, UniformTopology>) {
          const auto i = index_in(as_size(grid.points.x), as_size(grid.points.y));
          return grid.origin + grid.axes * Vec3{static_cast<double>(i[0]), static_cast<double>(i[1]),
                                                static_cast<double>(i[2])};
        } else if constexpr (std::is_same_v<Grid, RectilinearTopology>) {
          const auto i = index_in(grid.coordinates[0].size(), grid.coordinates[1].size());
          return Vec3{grid.coordinates[0][i[0]], grid.coordinates[1][i[1]], grid.coordinates[2][i[2]]};
        } else {
          return Vec3{grid.positions.at(point, 0), grid.positions.at(point, 1), grid.positions.at(point, 2)};
        }
      },
      data.topology);
}

}  // namespace palpate
