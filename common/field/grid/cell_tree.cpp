#include "common/field/grid/cell_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/math/power_of_two.h"

namespace palpate {
namespace {

struct Centre {
  std::array<float, 3> x;
  std::uint32_t cell;
};

/// A part of the order that is still to be split: places [first, first + 2^level) of the complete tree.
struct Range {
  std::size_t node;
  std::size_t first;
  std::size_t level;
};

/// Packs a place and an axis.
std::uint32_t pack(float split, std::size_t axis) noexcept {
  return (std::bit_cast<std::uint32_t>(split) & ~3U) | static_cast<std::uint32_t>(axis);
}

/// Splits the cells of a range across the longest side of their centres' box, the left part taking the full
/// 2^(level - 1) places. False where there is nothing to the right.
bool halve(std::vector<Centre>& centres, const Range& range, std::uint32_t& split) {
  const std::size_t first = range.first;
  const std::size_t last = std::min(centres.size(), first + (std::size_t{1} << range.level));
  const std::size_t cut = first + (std::size_t{1} << (range.level - 1));
  if (cut >= last) {
    split = pack(std::numeric_limits<float>::infinity(), 0);
    return false;
  }
  std::array<float, 3> lower;
  std::array<float, 3> upper;
  lower.fill(std::numeric_limits<float>::infinity());
  upper.fill(-std::numeric_limits<float>::infinity());
  for (std::size_t i = first; i < last; ++i) {
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
  const auto at = [&](std::size_t i) { return centres.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(first), at(cut), at(last), [axis](const Centre& a, const Centre& b) {
    return a.x[axis] != b.x[axis] ? a.x[axis] < b.x[axis] : a.cell < b.cell;
  });
  split = pack(centres[cut].x[axis], axis);
  return true;
}

/// Splits a range down to single cells.
void split_range(std::vector<Centre>& centres, const Range& range, std::span<std::uint32_t> splits) {
  if (range.level == 0) return;
  const bool both = halve(centres, range, splits[range.node]);
  const std::size_t half = std::size_t{1} << (range.level - 1);
  split_range(centres, {2 * range.node, range.first, range.level - 1}, splits);
  if (both) split_range(centres, {2 * range.node + 1, range.first + half, range.level - 1}, splits);
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

CellTree::CellTree(std::span<const Vec3> points, std::span<const Tet> cells, const Box& bounds, int threads)
    : cell_count_(cells.size()), origin_(bounds.lower) {
  // A query's own rounding to single precision must not lose it: boxes grow by one unit in the last place
  // of the mesh's size, and by what double precision cannot tell at these coordinates.
  double largest = 0.0;
  for (int a = 0; a < 3; ++a) {
    largest = std::max({largest, std::abs(bounds.lower[a]), std::abs(bounds.upper[a])});
  }
  const Vec3 size = bounds.size();
  margin_ = std::max({size.x, size.y, size.z}) * std::numeric_limits<float>::epsilon() +
            16.0 * largest * std::numeric_limits<double>::epsilon();

  std::vector<Centre> centres(cells.size());
  parallel_for(cells.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c) {
      Vec3 sum{0.0};
      for (const std::uint32_t v : cells[c]) sum += points[v] - origin_;
      for (int a = 0; a < 3; ++a) {
        centres[c].x[as_size(a)] = static_cast<float>(0.25 * sum[a]);
      }
      centres[c].cell = static_cast<std::uint32_t>(c);
    }
  });

  while ((std::size_t{1} << splits_) < cells.size()) ++splits_;
  split_.assign(std::size_t{1} << splits_, pack(std::numeric_limits<float>::infinity(), 0));

  // The first cuts are made level by level; the parts that they leave are independent.
  constexpr std::size_t kPartLevel = 14;
  std::vector<Range> parts{{1, 0, splits_}};
  while (parts.front().level > kPartLevel) {
    std::vector<std::uint8_t> both(parts.size());
    parallel_for(parts.size(), threads, [&](std::size_t first, std::size_t last) {
      for (std::size_t p = first; p < last; ++p)
        both[p] = halve(centres, parts[p], split_[parts[p].node]) ? 1 : 0;
    });
    std::vector<Range> halves;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const auto& [node, first, level] = parts[p];
      halves.push_back({2 * node, first, level - 1});
      if (both[p] != 0) halves.push_back({2 * node + 1, first + (std::size_t{1} << (level - 1)), level - 1});
    }
    parts = std::move(halves);
  }
  parallel_for(parts.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) split_range(centres, parts[p], split_);
  });

  order_.resize(cells.size());
  std::vector<std::array<float, 3>> places(cells.size());
  std::ranges::transform(centres, order_.begin(), &Centre::cell);
  std::ranges::transform(centres, places.begin(), &Centre::x);
  make_bins(size, places, threads);
}

void CellTree::finish(std::span<const Vec3> points, std::span<const Tet> cells, int threads) {
  PALPATE_ASSERT(cells.size() == cell_count_);
  if (cells.empty()) return;
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
              node.lower[as_size(a)][i] = round_down(box.lower[a] - margin_);
              node.upper[as_size(a)][i] = round_up(box.upper[a] + margin_);
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

void CellTree::make_bins(const Vec3& size, std::span<const std::array<float, 3>> centres, int threads) {
  // Cubes of the mean volume of a cell, larger where the mesh is so flat that they would be more than cells.
  constexpr double kMostAlong = 4096.0;
  const double unit = power_of_two(binary_exponent(std::max({size.x, size.y, size.z})));
  const Vec3 length = size / unit;
  const double cells_in_all = static_cast<double>(std::max<std::size_t>(1, cell_count_));
  double side = std::max(std::cbrt(length.x * length.y * length.z / cells_in_all), 1.0 / kMostAlong);
  double in_all = 0.0;
  do {
    in_all = 1.0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double along = length[static_cast<int>(a)];
      bins_[a] = static_cast<int>(std::clamp(along / side, 1.0, kMostAlong));
      bins_per_length_[a] = along > 0.0 ? static_cast<float>(bins_[a] / along / unit) : 0.0F;
      in_all *= bins_[a];
    }
    side *= 1.25;
  } while (in_all > 2.0 * cells_in_all);
  const auto count = floor_size(in_all);

  constexpr std::uint32_t kFew = 8;  // cells in a bin that a walk crosses faster than the tree is followed
  std::vector<std::uint32_t> cells(count, 0);
  for (const auto& centre : centres) ++cells[bin_of(centre)];
  bin_node_.resize(count);
  parallel_for(count, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t bin = first; bin < last; ++bin) {
      std::size_t rest = bin;
      std::array<float, 3> lower{};
      std::array<float, 3> middle{};
      std::array<float, 3> upper{};
      for (std::size_t a = 0; a < 3; ++a) {
        const auto i = static_cast<float>(rest % as_size(bins_[a]));
        rest /= as_size(bins_[a]);
        const float width = bins_per_length_[a] > 0.0F ? 1.0F / bins_per_length_[a] : 0.0F;
        lower[a] = i * width;
        middle[a] = (i + 0.5F) * width;
        upper[a] = (i + 1.0F) * width;
      }
      if (cells[bin] <= kFew) {
        bin_node_[bin] = static_cast<std::uint32_t>(descend(1, middle));
        continue;
      }
      // The lowest node above both corners is above the whole bin.
      std::size_t low = descend(1, lower);
      std::size_t high = descend(1, upper);
      while (low != high) {
        low /= 2;
        high /= 2;
      }
      bin_node_[bin] = static_cast<std::uint32_t>(low);
    }
  });
}

std::size_t CellTree::near(const Vec3& x) const noexcept {
  const std::array<float, 3> q = query(x);
  return std::min(descend(bin_node_[bin_of(q)], q) - (std::size_t{1} << splits_), cell_count_ - 1);
}

}  // namespace palpate
