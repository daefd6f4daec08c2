#include "common/field/grid/block_join.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "common/base/index.h"
#include "common/field/data_set_check.h"
#include "common/field/grid/cell_faces.h"
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

class Joiner {
 public:
  Joiner(std::span<const DataSet> blocks, const std::string& file, const PointsAgree& agree)
      : blocks_(blocks), file_(file), agree_(agree) {}

  JoinedPoints run() {
    gather_points();
    merge();
    return std::move(out_);
  }

 private:
  void gather_points() {
    std::size_t points = 0;
    std::size_t cells = 0;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      out_.first_point.push_back(static_cast<std::uint32_t>(points));
      check_block(blocks_[b], b, blocks_.size(), file_);
      points += blocks_[b].point_count();
      cells += blocks_[b].cell_count();
      if (points >= kNoPoint || cells >= kNoPoint) {
        throw block_error(blocks_[b], b, blocks_.size(), file_, "more than 2^32 - 2 points or cells",
                          "fewer");
      }
    }
    out_.points.reserve(points);
    out_.odd.reserve(points);
    for (const DataSet& block : blocks_) append_points(block);

    Box bounds;
    for (const Vec3& x : out_.points) {
      if (is_finite(x)) bounds.include(x);
    }
    const Vec3 size = bounds.size();
    out_.unit = power_of_two(-binary_exponent(std::max({size.x, size.y, size.z})));
  }

  void append_points(const DataSet& block) {
    const auto append_array = [this](const DataArray& positions) {
      for (std::size_t i = 0; i < positions.tuples; ++i) {
        out_.points.emplace_back(positions.at(i, 0), positions.at(i, 1), positions.at(i, 2));
      }
    };
    if (const auto* cells = std::get_if<UnstructuredTopology>(&block.topology)) {
      append_array(cells->positions);
      out_.odd.insert(out_.odd.end(), cells->positions.tuples, 0);
      return;
    }
    const Index3 n = structured_points(block);
    const auto* uniform = std::get_if<UniformTopology>(&block.topology);
    const auto* lines = std::get_if<RectilinearTopology>(&block.topology);
    if (const auto* grid = std::get_if<StructuredTopology>(&block.topology)) append_array(grid->positions);
    for (int k = 0; k < n.z; ++k) {
      for (int j = 0; j < n.y; ++j) {
        for (int i = 0; i < n.x; ++i) {
          out_.odd.push_back(static_cast<std::uint8_t>((i + j + k) & 1));
          if (uniform != nullptr) {
            out_.points.push_back(uniform->origin + uniform->axes * Vec3(i, j, k));
          } else if (lines != nullptr) {
            out_.points.emplace_back(lines->coordinates[0][as_size(i)], lines->coordinates[1][as_size(j)],
                                     lines->coordinates[2][as_size(k)]);
          }
        }
      }
    }
  }

  void merge() {
    std::vector<MergeCandidate> candidates;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const DataSet& block = blocks_[b];
      if (structured(block)) {
        // Uniform and rectilinear blocks have no seams of their own.
        const bool seams = std::holds_alternative<StructuredTopology>(block.topology);
        if (seams || blocks_.size() > 1) add_shell(b, seams, candidates);
      } else if (blocks_.size() > 1) {
        add_points(b, std::get<UnstructuredTopology>(block.topology), candidates);
      }
    }
    out_.place_of = merge_points(out_.points, candidates, kMergeDistance);
    out_.first_of = agree_ || doubled(candidates)
                        ? merge_points(out_.points, candidates, kMergeDistance, agree_, false)
                        : out_.place_of;
    for (std::size_t p = 0; p < out_.first_of.size(); ++p) out_.merged += out_.first_of[p] != p ? 1 : 0;
  }

  /// Whether points of one block that may not be joined lie at the same place, as those beside a thin wall do.
  [[nodiscard]] bool doubled(const std::vector<MergeCandidate>& candidates) const {
    constexpr std::uint32_t kNone = 0xFFFFFFFFU;
    std::vector<std::uint32_t> block_at(out_.points.size(), kNone);  // that came to the place last
    return std::ranges::any_of(candidates, [&](const MergeCandidate& p) {
      std::uint32_t& last = block_at[out_.place_of[p.point]];
      return std::exchange(last, p.block) == p.block && !p.within_block;
    });
  }

  void include_edge(double& spacing, std::size_t p, std::size_t q) const {
    const double length = glm::length((out_.points[p] - out_.points[q]) * out_.unit) / out_.unit;
    if (length > 0.0 && std::isfinite(length)) spacing = spacing == 0.0 ? length : std::min(spacing, length);
  }

  /// The points on the outer faces of a structured block.
  void add_shell(std::size_t b, bool seams, std::vector<MergeCandidate>& candidates) const {
    const Index3 n = structured_points(blocks_[b]);
    const std::array<std::size_t, 3> step{1, as_size(n.x), as_size(n.x) * as_size(n.y)};
    for (int k = 0; k < n.z; ++k) {
      for (int j = 0; j < n.y; ++j) {
        const bool shell_row = k == 0 || k == n.z - 1 || j == 0 || j == n.y - 1;
        const int stride = shell_row ? 1 : std::max(1, n.x - 1);
        for (int i = 0; i < n.x; i += stride) {
          const Index3 at{i, j, k};
          const std::size_t p =
              out_.first_point[b] + as_size(i) + step[1] * as_size(j) + step[2] * as_size(k);
          if (!is_finite(out_.points[p])) continue;
          double spacing = 0.0;
          for (std::size_t axis = 0; axis < 3; ++axis) {
            if (at[static_cast<int>(axis)] > 0) include_edge(spacing, p, p - step[axis]);
            if (at[static_cast<int>(axis)] + 1 < n[static_cast<int>(axis)]) {
              include_edge(spacing, p, p + step[axis]);
            }
          }
          candidates.push_back(
              {static_cast<std::uint32_t>(p), spacing, static_cast<std::uint32_t>(b), seams});
        }
      }
    }
  }

  /// All points that the volume cells of an unstructured block name.
  void add_points(std::size_t b, const UnstructuredTopology& cells,
                  std::vector<MergeCandidate>& candidates) const {
    const std::size_t count = cells.positions.tuples;
    std::vector<double> spacing(count, 0.0);
    std::vector<std::uint8_t> used(count, 0);
    const auto known = [&](std::int64_t id) { return id >= 0 && as_size(id) < count; };
    for (std::size_t c = 0; c < cells.types.size(); ++c) {
      if (!is_volume(cells.types[c]) || cells.types[c] == kPolyhedron) continue;
      const auto begin = as_size(cells.offsets[c]);
      const auto end = as_size(cells.offsets[c + 1]);
      for (std::size_t i = begin; i < end; ++i) {
        if (!known(cells.connectivity[i])) continue;  // refused when the cell is split
        const auto p = as_size(cells.connectivity[i]);
        used[p] = 1;
        const std::int64_t other = cells.connectivity[i + 1 < end ? i + 1 : begin];
        if (!known(other)) continue;
        const auto q = as_size(other);
        include_edge(spacing[p], out_.first_point[b] + p, out_.first_point[b] + q);
        include_edge(spacing[q], out_.first_point[b] + p, out_.first_point[b] + q);
      }
    }
    for_each_polyhedron_edge(cells, [&](std::size_t p, std::size_t q) {
      used[p] = 1;
      include_edge(spacing[p], out_.first_point[b] + p, out_.first_point[b] + q);
      include_edge(spacing[q], out_.first_point[b] + p, out_.first_point[b] + q);
    });
    for (std::size_t p = 0; p < count; ++p) {
      if (used[p] == 0 || !is_finite(out_.points[out_.first_point[b] + p])) continue;
      candidates.push_back({out_.first_point[b] + static_cast<std::uint32_t>(p), spacing[p],
                            static_cast<std::uint32_t>(b), false});
    }
  }

  std::span<const DataSet> blocks_;
  const std::string& file_;
  const PointsAgree& agree_;
  JoinedPoints out_;
};

}  // namespace

std::vector<std::uint32_t> merge_points(std::span<const Vec3> positions,
                                        std::span<const MergeCandidate> candidates, double distance,
                                        const PointsAgree& agree, bool through_others) {
  std::vector<std::uint32_t> first(positions.size());
  std::iota(first.begin(), first.end(), 0U);

  std::unordered_map<GridCell, std::uint32_t, GridCellHash> heads;  // first candidate in the cell
  heads.reserve(candidates.size());
  std::vector<std::uint32_t> next(candidates.size(), kEnd);
  std::vector<int> levels;  // in use
  // The other candidates that each first one stands for, the last first: those that their block parts, few, and
  // those that it does not.
  std::array<std::vector<std::uint32_t>, 2> joined;
  std::vector<std::uint32_t> joined_before(through_others ? 0 : candidates.size(), kEnd);
  joined.fill(joined_before);
  const auto parted = [](const MergeCandidate& p, const MergeCandidate& q) {
    return q.block == p.block && !(p.within_block && q.within_block);
  };
  const auto parted_from_joined = [&](const MergeCandidate& p, std::uint32_t first_one) {
    if (through_others) return false;
    for (std::size_t within = 0; within < (p.within_block ? 1 : 2); ++within) {
      int looked_at = 0;
      for (std::uint32_t j = joined[within][first_one]; j != kEnd; j = joined_before[j]) {
        if (parted(p, candidates[j]) || ++looked_at > kMostInCell) return true;
      }
    }
    return false;
  };

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
          if (parted(p, q)) continue;
          const Vec3 d = (x - positions[q.point]) * inverse;
          const double limit = distance * std::min(p.spacing, q.spacing) * inverse;
          if (glm::dot(d, d) <= limit * limit && (!agree || agree(p.point, q.point)) &&
              !parted_from_joined(p, j)) {
            found = j;
            break;
          }
        }
      }
      if (found != kEnd) break;
    }
    if (found != kEnd) {
      first[p.point] = candidates[found].point;
      if (!through_others) {
        std::uint32_t& last = joined[p.within_block ? 1 : 0][found];
        joined_before[i] = std::exchange(last, static_cast<std::uint32_t>(i));
      }
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

bool structured(const DataSet& block) noexcept {
  return !std::holds_alternative<UnstructuredTopology>(block.topology);
}

JoinedPoints join_blocks(std::span<const DataSet> blocks, const std::string& file, const PointsAgree& agree) {
  return Joiner(blocks, file, agree).run();
}

}  // namespace palpate
