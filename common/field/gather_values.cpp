#include <algorithm>
#include <limits>

#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/field/curved_split.h"
#include "common/field/field_grid.h"
#include "common/field/grid/tet_shape.h"

namespace palpate {
namespace {

/// Fixed weights from tuples of the data to one point of the grid.
struct Store {
  GatheredValues& out;
  int components;
  bool use_double;

  void put(std::size_t point, const double* value) const {
    const std::size_t at = point * as_size(components);
    for (int c = 0; c < components; ++c) {
      const auto i = at + as_size(c);
      if (use_double) {
        out.doubles[i] = value[c];
      } else {
        out.floats[i] = static_cast<float>(value[c]);
      }
    }
  }
};

void gather_box(const FieldGrid& grid, const DataSet& block, Association association, const TupleReader& read,
                const Store& store, int threads) {
  const Index3 n = grid.box->points();
  const auto slice = as_size(n.x) * as_size(n.y);
  parallel_for(as_size(n.z), threads, [&](std::size_t first, std::size_t last) {
    std::vector<double> value(as_size(store.components));
    std::vector<double> sum(value.size());
    for (std::size_t point = first * slice; point < last * slice; ++point) {
      const Index3 at{static_cast<int>(point % as_size(n.x)),
                      static_cast<int>(point / as_size(n.x) % as_size(n.y)), static_cast<int>(point / slice)};
      const std::size_t input = grid.data_index(n, at);
      if (!block.visible.empty() && block.visible[input] == 0) continue;
      if (association == Association::kPoint) {
        read(block, input, value.data());
        store.put(point, value.data());
        continue;
      }
      std::ranges::fill(sum, 0.0);
      double total = 0.0;
      for (unsigned corner = 0; corner < 8; ++corner) {
        const Index3 cell = at - Index3(corner & 1U, (corner >> 1U) & 1U, corner >> 2U);
        double volume = 1.0;
        for (int axis = 0; axis < 3; ++axis) {
          if (cell[axis] < 0 || cell[axis] >= n[axis] - 1) {
            volume = 0.0;
            break;
          }
          volume *= grid.box->coordinate(axis, cell[axis] + 1) - grid.box->coordinate(axis, cell[axis]);
        }
        if (volume == 0.0 || grid.box->hidden(cell)) continue;
        read(block, grid.data_index(n - 1, cell), value.data());
        for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += volume * value[c];
        total += volume;
      }
      for (double& s : sum) s /= total;
      store.put(point, sum.data());
    }
  });
}

/// Cells around each point of a tetrahedral mesh, by the tetrahedra that they became.
class CellsAroundPoints {
 public:
  explicit CellsAroundPoints(const FieldGrid& grid) : volume_(largest_cell(grid) + 1, 0.0) {
    const TetMesh& mesh = *grid.tets;
    const Vec3* points = mesh.points().data();
    begin_.assign(mesh.points().size() + 1, 0);
    // A cell's volume is summed over its tetrahedra in a fixed order, that of the mesh.
    for (std::size_t t = 0; t < mesh.cells().size(); ++t) {
      volume_[grid.source_cell[t]] += std::abs(TetShape(points, mesh.cells()[t]).volume6);
      for (const std::uint32_t v : mesh.cells()[t]) ++begin_[v + 1];
    }
    for (std::size_t v = 0; v + 1 < begin_.size(); ++v) begin_[v + 1] += begin_[v];
    cells_.resize(begin_.back());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t t = 0; t < mesh.cells().size(); ++t) {
      for (const std::uint32_t v : mesh.cells()[t]) cells_[next[v]++] = grid.source_cell[t];
    }
  }

  /// Each once, by rising number. Calls for different points may run at the same time.
  std::span<const std::uint32_t> around(std::size_t point) {
    const auto first = cells_.begin() + static_cast<std::ptrdiff_t>(begin_[point]);
    const auto last = cells_.begin() + static_cast<std::ptrdiff_t>(begin_[point + 1]);
    std::sort(first, last);
    return {first, std::unique(first, last)};
  }

  [[nodiscard]] double volume(std::uint32_t cell) const { return volume_[cell]; }

 private:
  static std::size_t largest_cell(const FieldGrid& grid) { return std::ranges::max(grid.source_cell); }

  std::vector<double> volume_;  ///< six times that of each cell
  std::vector<std::size_t> begin_;
  std::vector<std::uint32_t> cells_;
};

/// Points inside curved cells, of which none stands for a point of the data.
void gather_made(const MadePoints& made, std::span<const DataSet> blocks, const TupleReader& read,
                 std::vector<std::uint8_t>& done, const Store& store) {
  std::vector<std::size_t> first_point{0};
  for (const DataSet& block : blocks) first_point.push_back(first_point.back() + block.point_count());
  std::vector<double> value(as_size(store.components)), sum(value.size());
  for (std::size_t m = 0; m < made.point.size(); ++m) {
    if (made.point[m] == kNoPoint || done[made.point[m]] != 0) continue;
    done[made.point[m]] = 1;
    std::ranges::fill(sum, 0.0);
    for (std::size_t i = made.begin[m]; i < made.begin[m + 1]; ++i) {
      const auto above = std::ranges::upper_bound(first_point, std::size_t{made.input[i]});
      const auto b = as_size(above - first_point.begin()) - 1;
      read(blocks[b], made.input[i] - first_point[b], value.data());
      for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += made.weight[i] * value[c];
    }
    store.put(made.point[m], sum.data());
  }
}

void gather_tets(const FieldGrid& grid, std::span<const DataSet> blocks, Association association,
                 const TupleReader& read, const Store& store, int threads) {
  if (association == Association::kPoint) {
    std::vector<double> value(as_size(store.components));
    std::vector<std::uint8_t> done(grid.tets->points().size(), 0);
    std::size_t input = 0;
    for (const DataSet& block : blocks) {
      const std::size_t count = block.point_count();
      for (std::size_t i = 0; i < count; ++i, ++input) {
        const std::size_t point = grid.point_of_input.empty() ? input : as_size(grid.point_of_input[input]);
        if (point == kNoPoint || done[point] != 0) continue;
        if (!block.visible.empty() && block.visible[i] == 0) continue;
        done[point] = 1;
        read(block, i, value.data());
        store.put(point, value.data());
      }
    }
    if (grid.made) gather_made(*grid.made, blocks, read, done, store);
    return;
  }
  std::vector<std::size_t> first_cell{0};
  for (const DataSet& block : blocks) first_cell.push_back(first_cell.back() + block.cell_count());
  CellsAroundPoints cells(grid);
  parallel_for(grid.tets->points().size(), threads, [&](std::size_t first, std::size_t last) {
    std::vector<double> value(as_size(store.components));
    std::vector<double> sum(value.size());
    for (std::size_t point = first; point < last; ++point) {
      const auto around = cells.around(point);
      double total = 0.0;
      for (const std::uint32_t cell : around) total += cells.volume(cell);
      std::ranges::fill(sum, 0.0);
      for (const std::uint32_t cell : around) {
        const auto above = std::upper_bound(first_cell.begin(), first_cell.end(), cell);
        const auto block = as_size(above - first_cell.begin()) - 1;
        read(blocks[block], cell - first_cell[block], value.data());
        // Where no cell has a volume they all count the same.
        const double weight =
            total > 0.0 ? cells.volume(cell) / total : 1.0 / static_cast<double>(around.size());
        for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += weight * value[c];
      }
      store.put(point, sum.data());
    }
  });
}

}  // namespace

GatheredValues gather_values(const FieldGrid& grid, std::span<const DataSet> blocks, Association association,
                             int components, bool use_double, const TupleReader& read, int threads) {
  GatheredValues out;
  const std::size_t count = grid.point_count() * as_size(components);
  if (use_double) {
    out.doubles.assign(count, std::numeric_limits<double>::quiet_NaN());
  } else {
    out.floats.assign(count, std::numeric_limits<float>::quiet_NaN());
  }
  const Store store{out, components, use_double};
  if (grid.box) {
    gather_box(grid, blocks.front(), association, read, store, threads);
  } else {
    gather_tets(grid, blocks, association, read, store, threads);
  }
  return out;
}

}  // namespace palpate
