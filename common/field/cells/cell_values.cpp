#include "common/field/cells/cell_values.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <vector>

#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/field/cells/cell_fit.h"
#include "common/field/grid/tet_shape.h"
#include "common/math/lattice.h"

namespace palpate {
namespace {

/// Cells about a point, those that touch it first.
struct Stencil {
  std::vector<std::size_t> cells;  ///< numbers in the data, through all blocks
  std::vector<Vec3> centres;       ///< from the point
  std::vector<double> volumes;
  Mat3 spread{0.0};                ///< see CellFit::set()
  bool border = false;             ///< cells lie on one side of the point alone
  std::vector<std::size_t> front;  ///< what touches the cells: points of tetrahedra, cells of boxes
  std::vector<std::size_t> fresh;  ///< scratch
};

class BoxCells {
 public:
  explicit BoxCells(const FieldGrid& grid) : grid_(grid), box_(*grid.box), cells_(grid.box->points() - 1) {}

  void around(std::size_t point, Stencil& out) const {
    const Index3 at = unfold(cells_ + 1, point);
    for (unsigned corner = 0; corner < 8; ++corner) {
      const Index3 cell = at - Index3(corner & 1U, (corner >> 1U) & 1U, corner >> 2U);
      if (!add(cell, point, out)) {
        out.border = true;
        continue;
      }
      for (int axis = 0; axis < 3; ++axis) {
        const double width = box_.coordinate(axis, cell[axis] + 1) - box_.coordinate(axis, cell[axis]);
        out.spread[axis][axis] += 0.5 * width * width;
      }
    }
    out.spread /= std::max<double>(1.0, static_cast<double>(out.cells.size()));
  }

  /// Takes the cells that touch those that there are; hidden ones are walls.
  void grow(std::size_t point, Stencil& out) const {
    out.fresh = out.front;
    for (const std::size_t number : out.fresh) {
      const Index3 at = unfold(cells_, number);
      for (int d = 0; d < 27; ++d) {
        const Index3 cell = at + Index3(d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1);
        if (there(cell) && std::ranges::find(out.front, index_in(cells_, cell)) == out.front.end())
          add(cell, point, out);
      }
    }
  }

  /// The mean of the field over each cell that is there.
  template <typename Visit>
  void means(int components, const PointComponent& value_at, const Visit& visit) const {
    std::vector<double> mean(as_size(components));
    for (std::size_t number = 0; number < count_of(cells_); ++number) {
      const Index3 at = unfold(cells_, number);
      if (box_.hidden(at)) continue;
      std::ranges::fill(mean, 0.0);
      for (unsigned corner = 0; corner < 8; ++corner) {
        const std::size_t point =
            index_in(cells_ + 1, at + Index3(corner & 1U, (corner >> 1U) & 1U, corner >> 2U));
        for (int c = 0; c < components; ++c) mean[as_size(c)] += 0.125 * value_at(point, c);
      }
      visit(grid_.data_index(cells_, at), mean);
    }
  }

 private:
  static Index3 unfold(const Index3& n, std::size_t i) {
    return {static_cast<int>(i % as_size(n.x)), static_cast<int>(i / as_size(n.x) % as_size(n.y)),
            static_cast<int>(i / as_size(n.x) / as_size(n.y))};
  }
  [[nodiscard]] bool there(const Index3& cell) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (cell[axis] < 0 || cell[axis] >= cells_[axis]) return false;
    }
    return !box_.hidden(cell);
  }
  bool add(const Index3& cell, std::size_t point, Stencil& out) const {
    if (!there(cell)) return false;
    const Index3 at = unfold(cells_ + 1, point);
    Vec3 centre;
    double volume = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      // Differences first: the grid may lie far from its origin.
      const double here = box_.coordinate(axis, at[axis]);
      centre[axis] =
          0.5 * ((box_.coordinate(axis, cell[axis]) - here) + (box_.coordinate(axis, cell[axis] + 1) - here));
      volume *= box_.coordinate(axis, cell[axis] + 1) - box_.coordinate(axis, cell[axis]);
    }
    out.volumes.push_back(volume);
    out.front.push_back(index_in(cells_, cell));
    out.cells.push_back(grid_.data_index(cells_, cell));
    out.centres.push_back(centre);
    return true;
  }

  const FieldGrid& grid_;
  const BoxGrid& box_;
  Index3 cells_;
};

class TetCells {
 public:
  explicit TetCells(const FieldGrid& grid)
      : grid_(grid),
        mesh_(*grid.tets),
        begin_(mesh_.points().size() + 1, 0),
        border_(mesh_.points().size(), 0),
        volume_(std::size_t{std::ranges::max(grid.source_cell)} + 1, 0.0),
        centre_(volume_.size(), Vec3(0.0)) {
    std::vector<std::uint32_t> parts(volume_.size(), 0);
    // Sums over the tetrahedra of a cell in a fixed order, that of the mesh.
    for (std::size_t t = 0; t < mesh_.cells().size(); ++t) {
      const std::uint32_t cell = grid.source_cell[t];
      const double volume = volume_of(t);
      volume_[cell] += volume;
      ++parts[cell];
      for (const std::uint32_t v : mesh_.cells()[t]) ++begin_[v + 1];
      for (std::size_t face = 0; face < 4; ++face) {
        if (mesh_.neighbors()[t][face] != kNoCell) continue;
        for (std::size_t i = 1; i < 4; ++i) border_[mesh_.cells()[t][(face + i) % 4]] = 1;
      }
    }
    for (std::size_t t = 0; t < mesh_.cells().size(); ++t) {
      const std::uint32_t cell = grid.source_cell[t];
      const double share = volume_[cell] > 0.0 ? volume_of(t) / volume_[cell] : 1.0 / parts[cell];
      for (const std::uint32_t v : mesh_.cells()[t]) centre_[cell] += 0.25 * share * mesh_.points()[v];
    }
    for (std::size_t v = 0; v + 1 < begin_.size(); ++v) begin_[v + 1] += begin_[v];
    tets_.resize(begin_.back());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t t = 0; t < mesh_.cells().size(); ++t) {
      for (const std::uint32_t v : mesh_.cells()[t]) tets_[next[v]++] = static_cast<std::uint32_t>(t);
    }
  }

  void around(std::size_t point, Stencil& out) const {
    const Vec3& x = mesh_.points()[point];
    out.border = border_[point] != 0;
    std::size_t corners = 0;
    for (const std::uint32_t t : tets_of(point)) {
      out.fresh.push_back(grid_.source_cell[t]);
      for (const std::uint32_t v : mesh_.cells()[t]) {
        if (v == point) continue;
        const Vec3 way = mesh_.points()[v] - x;
        out.spread += glm::outerProduct(way, way);
        out.front.push_back(v);
        ++corners;
      }
    }
    out.spread /= std::max<double>(1.0, static_cast<double>(corners));
    take_fresh(x, out);
  }

  /// Takes the cells that touch the corners of tetrahedra about the point, and so on.
  void grow(std::size_t point, Stencil& out) const {
    sort_unique(out.front);
    const std::vector<std::size_t> front = out.front;
    for (const std::size_t v : front) {
      for (const std::uint32_t t : tets_of(v)) {
        out.fresh.push_back(grid_.source_cell[t]);
        out.front.insert(out.front.end(), mesh_.cells()[t].begin(), mesh_.cells()[t].end());
      }
    }
    take_fresh(mesh_.points()[point], out);
  }

  template <typename Visit>
  void means(int components, const PointComponent& value_at, const Visit& visit) const {
    const auto n = as_size(components);
    std::vector<double> sums(volume_.size() * n, 0.0);
    for (std::size_t t = 0; t < mesh_.cells().size(); ++t) {
      const std::uint32_t cell = grid_.source_cell[t];
      if (!(volume_[cell] > 0.0)) continue;
      const double share = 0.25 * volume_of(t) / volume_[cell];
      for (const std::uint32_t v : mesh_.cells()[t]) {
        for (std::size_t c = 0; c < n; ++c) sums[cell * n + c] += share * value_at(v, static_cast<int>(c));
      }
    }
    for (std::size_t cell = 0; cell < volume_.size(); ++cell) {
      if (volume_[cell] > 0.0) visit(cell, std::span(sums).subspan(cell * n, n));
    }
  }

 private:
  static void sort_unique(std::vector<std::size_t>& list) {
    std::ranges::sort(list);
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  [[nodiscard]] double volume_of(std::size_t t) const {
    return std::abs(TetShape(mesh_.points().data(), mesh_.cells()[t]).volume6);
  }
  [[nodiscard]] std::span<const std::uint32_t> tets_of(std::size_t point) const {
    return std::span(tets_).subspan(begin_[point], begin_[point + 1] - begin_[point]);
  }
  /// Cells without a volume have no value worth having, unless there are no others.
  void take_fresh(const Vec3& x, Stencil& out) const {
    sort_unique(out.fresh);
    const bool any = std::ranges::any_of(out.fresh, [&](std::size_t c) { return volume_[c] > 0.0; });
    std::vector<std::size_t> known = out.cells;
    std::ranges::sort(known);
    for (const std::size_t cell : out.fresh) {
      if (std::ranges::binary_search(known, cell) || (any && !(volume_[cell] > 0.0))) continue;
      out.cells.push_back(cell);
      out.centres.push_back(centre_[cell] - x);
      out.volumes.push_back(volume_[cell]);
    }
    out.fresh.clear();
  }

  const FieldGrid& grid_;
  const TetMesh& mesh_;
  std::vector<std::size_t> begin_;    ///< of each point in tets_
  std::vector<std::uint32_t> tets_;   ///< around each point
  std::vector<std::uint8_t> border_;  ///< points
  std::vector<double> volume_;        ///< six times that of each cell
  std::vector<Vec3> centre_;          ///< of mass, frame L
};

/// Reads values of cells by their numbers through all blocks.
class ReadCell {
 public:
  ReadCell(std::span<const DataSet> blocks, const TupleReader& read) : blocks_(blocks), read_(read) {
    for (const DataSet& block : blocks) first_.push_back(first_.back() + block.cell_count());
  }
  void operator()(std::size_t cell, double* out) const {
    const auto above = std::upper_bound(first_.begin(), first_.end(), cell);
    const auto block = as_size(above - first_.begin()) - 1;
    read_(blocks_[block], cell - first_[block], out);
  }

 private:
  std::span<const DataSet> blocks_;
  const TupleReader& read_;
  std::vector<std::size_t> first_{0};
};

template <class Cells>
std::size_t bring(const Cells& cells, std::size_t points, int components, const ReadCell& read,
                  const PutValue& put, CellRule rule, int threads) {
  // Cells farther off tell nothing of the point.
  constexpr int kRings = 3;
  const auto n = as_size(components);
  std::atomic<std::size_t> flat{0};
  parallel_for(points, threads, [&](std::size_t first, std::size_t last) {
    Stencil stencil;
    CellFit fit;
    std::vector<double> values, value(n);
    // Values of cells from number `known` on; those that are not finite go.
    const auto read_from = [&](std::size_t known, bool keep_all) {
      std::size_t kept = known;
      for (std::size_t i = known; i < stencil.cells.size(); ++i) {
        values.resize((kept + 1) * n);
        double* const at = values.data() + kept * n;
        read(stencil.cells[i], at);
        if (!keep_all && !std::all_of(at, at + n, [](double v) { return std::isfinite(v); })) continue;
        stencil.cells[kept] = stencil.cells[i];
        stencil.centres[kept++] = stencil.centres[i];
      }
      stencil.cells.resize(kept);
      stencil.centres.resize(kept);
      values.resize(kept * n);
    };
    const auto put_mean = [&](std::size_t point) {
      double total = 0.0;
      for (const double volume : stencil.volumes) total += volume;
      std::ranges::fill(value, 0.0);
      for (std::size_t i = 0; i < stencil.cells.size(); ++i) {
        // Where no cell has a volume they all count the same.
        const double weight =
            total > 0.0 ? stencil.volumes[i] / total : 1.0 / static_cast<double>(stencil.cells.size());
        for (std::size_t c = 0; c < n; ++c) value[c] += weight * values[i * n + c];
      }
      put(point, value.data());
    };
    for (std::size_t point = first; point < last; ++point) {
      stencil.cells.clear();
      stencil.centres.clear();
      stencil.volumes.clear();
      stencil.front.clear();
      stencil.spread = Mat3(0.0);
      stencil.border = false;
      cells.around(point, stencil);
      const std::size_t near = stencil.cells.size();
      if (near == 0) continue;
      read_from(0, true);
      if (rule == CellRule::kMean) {
        put_mean(point);
        continue;
      }
      if (!stencil.border) fit.set(stencil.centres, near, stencil.spread);
      for (int ring = 2; ring <= kRings && ((ring == 2 && stencil.border) || fit.flat()); ++ring) {
        const std::size_t known = stencil.cells.size();
        cells.grow(point, stencil);
        read_from(known, false);
        fit.set(stencil.centres, near, stencil.spread);
      }
      if (fit.flat()) ++flat;
      for (std::size_t c = 0; c < n; ++c) value[c] = fit.value(std::span(values).subspan(c), n);
      put(point, value.data());
    }
  });
  return flat;
}

template <class Cells>
CellDifference difference(const Cells& cells, int components, const ReadCell& read,
                          const PointComponent& value_at) {
  std::vector<double> value(as_size(components));
  double largest = 0.0, most = 0.0, squares = 0.0;
  std::size_t count = 0;
  cells.means(components, value_at, [&](std::size_t cell, std::span<const double> mean) {
    read(cell, value.data());
    double size = 0.0, off = 0.0;
    for (std::size_t c = 0; c < value.size(); ++c) {
      size = std::hypot(size, value[c]);
      off = std::hypot(off, mean[c] - value[c]);
    }
    if (!std::isfinite(size) || !std::isfinite(off)) return;
    largest = std::max(largest, size);
    most = std::max(most, off);
    squares += off * off;
    ++count;
  });
  if (!(largest > 0.0)) return {};
  const double rms = std::sqrt(squares / static_cast<double>(count));
  return {.largest = most / largest, .rms = rms / largest, .flat = 0};
}

}  // namespace

CellDifference bring_to_points(const FieldGrid& grid, std::span<const DataSet> blocks, int components,
                               const TupleReader& read, const PutValue& put, const PointComponent& value_at,
                               CellRule rule, int threads) {
  const ReadCell read_cell(blocks, read);
  const auto bring_from = [&](const auto& cells) {
    const std::size_t flat = bring(cells, grid.point_count(), components, read_cell, put, rule, threads);
    CellDifference out = difference(cells, components, read_cell, value_at);
    out.flat = flat;
    return out;
  };
  return grid.tets ? bring_from(TetCells(grid)) : bring_from(BoxCells(grid));
}

std::string cell_values_note(const CellDifference& difference) {
  std::array<char, 400> text{};
  std::snprintf(
      text.data(), text.size(),
      "cell values brought to the points: least squares from the cells around; means over the cells "
      "then differ from their values by up to %.3g %% of the largest, %.3g %% rms",
      100.0 * difference.largest, 100.0 * difference.rms);
  std::string out = text.data();
  if (difference.flat > 0) {
    out += "; " + std::to_string(difference.flat) + (difference.flat == 1 ? " point has" : " points have") +
           " cells in one layer alone: no change across it";
  }
  return out;
}

}  // namespace palpate
