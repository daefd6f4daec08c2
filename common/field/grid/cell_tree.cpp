#include "common/field/grid/cell_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "common/base/check.h"
#include "common/base/parallel.h"

namespace palpate {
namespace {

struct Centre {
  std::array<float, 3> x;
  std::uint32_t cell;
};

/// A part of the order that is still to be split.
struct Range {
  std::size_t first;
  std::size_t last;
};

/// Puts the cells of `range` that belong before `cut` there, across the longest side of the centres' box.
void halve(std::vector<Centre>& centres, const Range& range, std::size_t cut) {
  std::array<float, 3> lower;
  std::array<float, 3> upper;
  lower.fill(std::numeric_limits<float>::infinity());
  upper.fill(-std::numeric_limits<float>::infinity());
  for (std::size_t i = range.first; i < range.last; ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      lower[a] = std::min(lower[a], centres[i].x[a]);
      upper[a] = std::max(upper[a], centres[i].x[a]);
    }
  }
  std::size_t axis = 0;
  for (std::size_t a = 1; a < 3; ++a) {
    if (upper[a] - lower[a] > upper[axis] - lower[axis]) axis = a;
  }
  // Ties fall to the index, so that the order is the same on every library.
  std::nth_element(centres.begin() + static_cast<std::ptrdiff_t>(range.first),
                   centres.begin() + static_cast<std::ptrdiff_t>(cut),
                   centres.begin() + static_cast<std::ptrdiff_t>(range.last),
                   [axis](const Centre& a, const Centre& b) {
                     return a.x[axis] != b.x[axis] ? a.x[axis] < b.x[axis] : a.cell < b.cell;
                   });
}

/// Where the complete tree over leaves cuts a range: the left part takes a power of two of leaves.
std::size_t cut_of(const Range& range) {
  const std::size_t leaves = (range.last - range.first + CellTree::kLeafCells - 1) / CellTree::kLeafCells;
  return range.first + std::bit_ceil(leaves) / 2 * CellTree::kLeafCells;
}

/// Splits down to single leaves.
void split(std::vector<Centre>& centres, Range range) {
  while (range.last - range.first > CellTree::kLeafCells) {
    const std::size_t cut = cut_of(range);
    halve(centres, range, cut);
    split(centres, {range.first, cut});
    range.first = cut;
  }
}

float round_down(double x) noexcept {
  const auto f = static_cast<float>(x);
  return f <= x ? f : std::nextafter(f, -std::numeric_limits<float>::infinity());
}

float round_up(double x) noexcept {
  const auto f = static_cast<float>(x);
  return f >= x ? f : std::nextafter(f, std::numeric_limits<float>::infinity());
}

}  // namespace

std::vector<std::uint32_t> CellTree::order(std::span<const Vec3> points, std::span<const Tet> cells,
                                           int threads) {
  std::vector<Centre> centres(cells.size());
  Box bounds;
  for (const Tet& cell : cells) bounds.include(points[cell[0]]);
  parallel_for(cells.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c) {
      Vec3 sum{0.0};
      for (const std::uint32_t v : cells[c]) sum += points[v] - bounds.lower;
      for (int a = 0; a < 3; ++a) {
        centres[c].x[static_cast<std::size_t>(a)] = static_cast<float>(0.25 * sum[a]);
      }
      centres[c].cell = static_cast<std::uint32_t>(c);
    }
  });

  // The first cuts are made one by one; the parts that they leave are independent.
  constexpr std::size_t kPartCells = 1U << 14U;
  std::vector<Range> parts;
  std::vector<Range> pending{{0, cells.size()}};
  while (!pending.empty()) {
    const Range range = pending.back();
    pending.pop_back();
    if (range.last - range.first <= kPartCells) {
      parts.push_back(range);
      continue;
    }
    const std::size_t cut = cut_of(range);
    halve(centres, range, cut);
    pending.push_back({range.first, cut});
    pending.push_back({cut, range.last});
  }
  parallel_for(parts.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) split(centres, parts[p]);
  });

  std::vector<std::uint32_t> order(cells.size());
  std::ranges::transform(centres, order.begin(), &Centre::cell);
  return order;
}

CellTree::CellTree(std::span<const Vec3> points, std::span<const Tet> cells, const Box& bounds, int threads)
    : cell_count_(cells.size()), origin_(bounds.lower) {
  if (cells.empty()) return;
  // A query's own rounding to single precision must not lose it: boxes grow by one unit in the last place
  // of the mesh's size, and by what double precision cannot tell at these coordinates.
  const Vec3 size = bounds.size();
  const double largest =
      std::max({std::abs(bounds.lower.x), std::abs(bounds.lower.y), std::abs(bounds.lower.z),
                std::abs(bounds.upper.x), std::abs(bounds.upper.y), std::abs(bounds.upper.z)});
  const double margin = std::max({size.x, size.y, size.z}) * std::numeric_limits<float>::epsilon() +
                        16.0 * largest * std::numeric_limits<double>::epsilon();

  std::size_t count = (cells.size() + kLeafCells - 1) / kLeafCells;  // boxes of the level below
  bool leaves = true;
  do {
    const std::size_t nodes = (count + kWidth - 1) / kWidth;
    std::vector<Node> level(nodes);
    const std::vector<Node>* below = levels_.empty() ? nullptr : &levels_.back();
    parallel_for(nodes, threads, [&](std::size_t first, std::size_t last) {
      for (std::size_t n = first; n < last; ++n) {
        Node& node = level[n];
        for (std::size_t i = 0; i < kWidth; ++i) {
          const std::size_t child = n * kWidth + i;
          for (std::size_t a = 0; a < 3; ++a) {
            node.lower[a][i] = std::numeric_limits<float>::infinity();
            node.upper[a][i] = -std::numeric_limits<float>::infinity();
          }
          if (child >= count) continue;
          if (leaves) {
            Box box;
            const std::size_t end = std::min(cells.size(), (child + 1) * kLeafCells);
            for (std::size_t c = child * kLeafCells; c < end; ++c) {
              for (const std::uint32_t v : cells[c]) box.include(points[v] - origin_);
            }
            for (int a = 0; a < 3; ++a) {
              node.lower[static_cast<std::size_t>(a)][i] = round_down(box.lower[a] - margin);
              node.upper[static_cast<std::size_t>(a)][i] = round_up(box.upper[a] + margin);
            }
            continue;
          }
          const Node& source = (*below)[child];
          for (std::size_t a = 0; a < 3; ++a) {
            node.lower[a][i] = *std::ranges::min_element(source.lower[a]);
            node.upper[a][i] = *std::ranges::max_element(source.upper[a]);
          }
        }
      }
    });
    levels_.push_back(std::move(level));
    count = nodes;
    leaves = false;
  } while (count > 1);
}

std::size_t CellTree::near(const Vec3& x) const noexcept {
  PALPATE_ASSERT(!levels_.empty());
  const std::array<float, 3> q = query(x);
  std::size_t node = 0;
  for (std::size_t level = levels_.size(); level-- > 0;) {
    const Node& boxes = levels_[level][node];
    // Of the boxes that hold x the one whose centre is nearest, measured in the box's own size; where
    // none does, the one that is left by least. Children that do not exist have empty boxes.
    std::size_t best = 0;
    float best_distance = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < kWidth; ++i) {
      if (!(boxes.lower[0][i] <= boxes.upper[0][i])) continue;
      float distance = 0.0F;
      for (std::size_t a = 0; a < 3; ++a) {
        const float half = 0.5F * (boxes.upper[a][i] - boxes.lower[a][i]);
        const float off = std::abs(q[a] - 0.5F * (boxes.upper[a][i] + boxes.lower[a][i]));
        distance = std::max(distance, off / half);
      }
      if (distance < best_distance) {
        best_distance = distance;
        best = i;
      }
    }
    node = node * kWidth + best;
  }
  return std::min(node * kLeafCells, cell_count_ - 1);
}

}  // namespace palpate
