#include "common/field/grid/point_merge.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "common/base/index.h"
#include "common/math/power_of_two.h"

namespace palpate {
namespace {

/// A hash grid for each power of two of spacing: its cells are as large as the spacing of the points in
/// it, so they hold few points however much the mesh is graded, and a search looks at one cell a level,
/// more only next to a cell's border.
struct GridCell {
  int level = 0;  ///< cells have the size 2^level
  std::array<double, 3> index{};
  bool operator==(const GridCell&) const = default;
};

struct GridCellHash {
  std::size_t operator()(const GridCell& cell) const noexcept {
    auto hash = static_cast<std::uint64_t>(cell.level);
    for (const double i : cell.index) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(i + 0.0)) * 0x9E3779B97F4A7C15ULL;
      hash ^= hash >> 29U;
    }
    return hash;
  }
};

/// More points in one grid cell than any mesh has: blocks of nothing but coincident points would make the
/// search quadratic.
constexpr int kMostInCell = 1000;

constexpr std::uint32_t kEnd = 0xFFFFFFFFU;

}  // namespace

std::vector<std::uint32_t> merge_points(std::span<const Vec3> positions,
                                        std::span<const MergeCandidate> candidates, double distance) {
  std::vector<std::uint32_t> first(positions.size());
  std::iota(first.begin(), first.end(), 0U);

  std::unordered_map<GridCell, std::uint32_t, GridCellHash> heads;  // first candidate in the cell
  heads.reserve(candidates.size());
  std::vector<std::uint32_t> next(candidates.size(), kEnd);
  std::vector<int> levels;  // in use

  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const MergeCandidate& p = candidates[i];
    const Vec3& x = positions[p.point];
    std::uint32_t found = kEnd;
    for (const int level : levels) {
      const double inverse = power_of_two(-level);
      const double reach = distance * std::min(p.spacing, power_of_two(level + 1));
      std::array<std::array<double, 2>, 3> range;
      for (int a = 0; a < 3; ++a) {
        range[as_size(a)] = {std::floor((x[a] - reach) * inverse), std::floor((x[a] + reach) * inverse)};
      }
      for (unsigned corner = 0; corner < 8 && found == kEnd; ++corner) {
        GridCell cell{level, {range[0][corner & 1U], range[1][(corner >> 1U) & 1U], range[2][corner >> 2U]}};
        // Cells that the reach does not leave are looked at once.
        if (((corner & 1U) != 0 && range[0][0] == range[0][1]) ||
            ((corner & 2U) != 0 && range[1][0] == range[1][1]) ||
            ((corner & 4U) != 0 && range[2][0] == range[2][1])) {
          continue;
        }
        const auto head = heads.find(cell);
        if (head == heads.end()) continue;
        int looked_at = 0;
        for (std::uint32_t j = head->second; j != kEnd && ++looked_at <= kMostInCell; j = next[j]) {
          const MergeCandidate& q = candidates[j];
          if (q.block == p.block && !(p.within_block && q.within_block)) continue;
          const Vec3 d = (x - positions[q.point]) * inverse;
          const double limit = distance * std::min(p.spacing, q.spacing) * inverse;
          if (glm::dot(d, d) <= limit * limit) {
            found = j;
            break;
          }
        }
      }
      if (found != kEnd) break;
    }
    if (found != kEnd) {
      first[p.point] = candidates[found].point;
      continue;
    }
    const int level = binary_exponent(p.spacing);
    const double inverse = power_of_two(-level);
    const GridCell cell{level,
                        {std::floor(x.x * inverse), std::floor(x.y * inverse), std::floor(x.z * inverse)}};
    const auto [head, fresh] = heads.try_emplace(cell, static_cast<std::uint32_t>(i));
    if (!fresh) {
      next[i] = head->second;
      head->second = static_cast<std::uint32_t>(i);
    } else if (std::ranges::find(levels, level) == levels.end()) {
      levels.push_back(level);
    }
  }
  return first;
}

}  // namespace palpate
