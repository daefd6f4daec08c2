#include "common/field/cells/hexahedron_difference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "common/base/index.h"
#include "common/field/data_set_check.h"
#include "common/field/field_grid.h"
#include "common/field/grid/cell_faces.h"
#include "common/field/grid/cell_split.h"

namespace palpate {
namespace {

/// Points of a cell in the order of a lattice (x fastest), counted within the block.
using Corners = std::array<std::size_t, 8>;

std::optional<Corners> corners_of(const DataSet& block, std::size_t cell) {
  if (const auto* cells = std::get_if<UnstructuredTopology>(&block.topology)) {
    const std::uint8_t type = cells->types[cell];
    if (type != kHexahedron && type != kVoxel) return std::nullopt;
    const std::int64_t* v = cells->connectivity.data() + cells->offsets[cell];
    static constexpr std::array<std::size_t, 8> kFromHexahedron{0, 1, 3, 2, 4, 5, 7, 6};
    Corners out{};
    for (std::size_t i = 0; i < 8; ++i) {
      out[i] = as_size(v[type == kVoxel ? i : kFromHexahedron[i]]);
    }
    return out;
  }
  const Index3 n = structured_points(block);
  if (n.x < 2 || n.y < 2 || n.z < 2) return std::nullopt;
  const auto row = as_size(n.x);
  const std::size_t slice = row * as_size(n.y);
  const std::size_t i = cell % (row - 1);
  const std::size_t j = cell / (row - 1) % as_size(n.y - 1);
  const std::size_t k = cell / ((row - 1) * as_size(n.y - 1));
  const std::size_t p = i + row * j + slice * k;
  return Corners{p,         p + 1,         p + row,         p + row + 1,
                 p + slice, p + slice + 1, p + slice + row, p + slice + row + 1};
}

Vec3 value_at(const PointVectors& values, std::size_t point) {
  return std::visit(
      [&](const auto& numbers) {
        return Vec3{static_cast<double>(numbers[3 * point]), static_cast<double>(numbers[3 * point + 1]),
                    static_cast<double>(numbers[3 * point + 2])};
      },
      values.values);
}

}  // namespace

HexahedronDifference hexahedron_difference(const VectorField& field, std::span<const DataSet> blocks,
                                           std::size_t most_cells) {
  HexahedronDifference out;
  if (field.tet_mesh() == nullptr || most_cells == 0 || field.max_speed() == 0.0) return out;
  const FieldGrid& grid = *field.grid();
  const std::size_t stride = (grid.input_cells + most_cells - 1) / most_cells;
  const double largest = field.max_speed() / field.frame().speed_scale();  // local units, as all below
  const Vec3* points = field.tet_mesh()->points().data();

  double squares = 0.0;
  std::size_t samples = 0;
  std::size_t first_point = 0;
  std::size_t next = 0;  // cell to be sampled, counted through all blocks
  std::size_t first_cell = 0;
  CellHint hint;
  for (const DataSet& block : blocks) {
    const std::size_t cells = block.cell_count();
    for (; next < first_cell + cells; next += stride) {
      const auto corners = corners_of(block, next - first_cell);
      if (!corners) continue;
      std::array<Vec3, 8> x;
      std::array<Vec3, 8> v;
      bool usable = true;
      for (std::size_t c = 0; c < 8 && usable; ++c) {
        std::size_t point = first_point + (*corners)[c];
        if (!grid.point_of_input.empty()) point = grid.point_of_input[point];
        usable = point != kNoPoint;
        if (!usable) break;
        x[c] = points[point];
        v[c] = value_at(field.values(), point) * field.values().scale;
        usable = is_finite(v[c]);
      }
      if (!usable) continue;
      ++out.cells;
      for (int sample = 0; sample < 27; ++sample) {
        const Vec3 u = Vec3(1 + 2 * (sample % 3), 1 + 2 * (sample / 3 % 3), 1 + 2 * (sample / 9)) / 6.0;
        Vec3 at{0.0};
        Vec3 trilinear{0.0};
        for (unsigned c = 0; c < 8; ++c) {
          const double weight = ((c & 1U) != 0 ? u.x : 1.0 - u.x) * ((c & 2U) != 0 ? u.y : 1.0 - u.y) *
                                ((c & 4U) != 0 ? u.z : 1.0 - u.z);
          at += weight * x[c];
          trilinear += weight * v[c];
        }
        const VectorSample found = field.sample(field.frame().data_from_local(at), hint);
        if (found.status != SampleStatus::kOk) continue;  // bulges of faces on the border
        const double difference =
            glm::length(found.value * power_of_two(-field.frame().speed_exponent) - trilinear) / largest;
        out.max = std::max(out.max, difference);
        squares += difference * difference;
        ++samples;
      }
    }
    first_cell += cells;
    first_point += block.point_count();
  }
  if (samples > 0) out.rms = std::sqrt(squares / static_cast<double>(samples));
  return out;
}

}  // namespace palpate
