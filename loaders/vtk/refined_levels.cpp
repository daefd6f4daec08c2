#include "loaders/vtk/refined_levels.h"

#include <algorithm>
#include <cmath>

#include "common/base/index.h"

namespace palpate {
namespace {

/// The cells i to j - 1 along each axis of `coarse` whose middles lie in `fine`; none where their axes differ.
bool covered_cells(const UniformTopology& coarse, const UniformTopology& fine, Index3& begin, Index3& end) {
  constexpr double kParallel = 1e-9;
  const Mat3 to_cells = glm::inverse(coarse.axes);
  const Mat3 steps = to_cells * fine.axes;
  const Vec3 lower = to_cells * (fine.origin - coarse.origin);
  for (int axis = 0; axis < 3; ++axis) {
    for (int other = 0; other < 3; ++other) {
      if (other != axis && !(std::abs(steps[axis][other]) <= kParallel * std::abs(steps[axis][axis])))
        return false;
    }
    const double first = lower[axis], last = first + steps[axis][axis] * (fine.points[axis] - 1);
    const double cells = coarse.points[axis] - 1;
    begin[axis] = static_cast<int>(std::clamp(std::ceil(std::min(first, last) - 0.5), 0.0, cells));
    end[axis] = static_cast<int>(std::clamp(std::ceil(std::max(first, last) - 0.5), 0.0, cells));
  }
  return begin.x < end.x && begin.y < end.y && begin.z < end.z;
}

/// Blanks the points that no visible cell has.
void blank_points(DataSet& block, const Index3& points) {
  std::vector<std::uint8_t> seen(block.point_count(), 0);
  std::size_t cell = 0;
  for (int k = 0; k + 1 < points.z; ++k) {
    for (int j = 0; j + 1 < points.y; ++j) {
      for (int i = 0; i + 1 < points.x; ++i, ++cell) {
        if (block.hidden_cells[cell] != 0) continue;
        for (int corner = 0; corner < 8; ++corner) {
          const int x = i + corner % 2, y = j + corner / 2 % 2, z = k + corner / 4;
          seen[as_size(x) + as_size(points.x) * (as_size(y) + as_size(points.y) * as_size(z))] = 1;
        }
      }
    }
  }
  if (block.visible.empty()) block.visible.assign(seen.size(), 1);
  for (std::size_t p = 0; p < seen.size(); ++p) block.visible[p] = block.visible[p] != 0 ? seen[p] : 0;
}

}  // namespace

std::size_t hide_refined_cells(std::vector<DataSet>& blocks, std::span<const int> levels) {
  std::size_t hidden = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const auto* const coarse = std::get_if<UniformTopology>(&blocks[b].topology);
    if (coarse == nullptr || levels[b] < 0) continue;
    std::vector<std::uint8_t>& marks = blocks[b].hidden_cells;
    std::size_t here = 0;
    for (std::size_t f = 0; f < blocks.size(); ++f) {
      const auto* const fine = std::get_if<UniformTopology>(&blocks[f].topology);
      Index3 begin{0}, end{0};
      if (fine == nullptr || levels[f] <= levels[b] || !covered_cells(*coarse, *fine, begin, end)) continue;
      if (marks.empty()) marks.assign(blocks[b].cell_count(), 0);
      for (int k = begin.z; k < end.z; ++k) {
        for (int j = begin.y; j < end.y; ++j) {
          for (int i = begin.x; i < end.x; ++i) {
            std::uint8_t& mark =
                marks[as_size(i) + as_size(coarse->points.x - 1) *
                                       (as_size(j) + as_size(coarse->points.y - 1) * as_size(k))];
            here += mark == 0 ? 1 : 0;
            mark = 1;
          }
        }
      }
    }
    if (here > 0) blank_points(blocks[b], coarse->points);
    hidden += here;
  }
  return hidden;
}

}  // namespace palpate
