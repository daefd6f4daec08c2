/// Index over the cells of a tetrahedral mesh: a cell near a point, and all cells that may hold it.
///
/// Cells are put in the order of a k-d tree (halving the longest side of the centres' box), so that runs of
/// neighbours are compact. Two trees over the cells need no links then:
///   - the k-d tree itself, one number a node: where it was halved. Followed down, it gives a cell near x. A
///     table of even bins, about as many as cells, says at which node to begin: at the bottom where cells are
///     about as large as bins, higher up where they are finer.
///   - boxes around runs of kLeafCells, four to a node: node n of a level covers nodes 4 n … 4 n + 3 of the
///     level below. They name every cell that may hold x.
/// Numbers are stored in single precision, relative to the mesh's lower corner; boxes are rounded outwards.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "common/base/index.h"
#include "common/base/memory.h"
#include "common/math/vec.h"

namespace palpate {

class CellTree {
 public:
  using Tet = std::array<std::uint32_t, 4>;
  static constexpr std::size_t kLeafCells = 4;
  static constexpr std::size_t kWidth = 4;

  CellTree() = default;
  /// Plans the order of the cells and keeps the k-d tree. Call finish() when they are in that order.
  CellTree(std::span<const Vec3> points, std::span<const Tet> cells, const Box& bounds, int threads);

  /// The order that the tree wants: a permutation of the cells' indices. Leaves the tree without it.
  [[nodiscard]] std::vector<std::uint32_t> take_order() { return std::move(order_); }
  /// Puts boxes around the cells. @pre `cells` are in the order of take_order().
  void finish(std::span<const Vec3> points, std::span<const Tet> cells, int threads);

  /// A cell near `x`. @rt Safe.
  [[nodiscard]] std::size_t near(const Vec3& x) const noexcept;

  /// Calls `visit(first, last)` for the cells of every leaf whose box meets the box from `lower` to `upper`, or holds
  /// a point, where both are it, until it returns true. @rt Safe.
  template <typename Visit>
  void visit_leaves(const Vec3& lower, const Vec3& upper, Visit&& visit) const noexcept;

 private:
  void make_bins(const Vec3& size, std::span<const std::array<float, 3>> centres, int threads);
  [[nodiscard]] std::size_t bin_of(const std::array<float, 3>& q) const noexcept {
    std::array<int, 3> at{};
    for (std::size_t a = 0; a < 3; ++a) {
      const auto i = static_cast<int>(q[a] * bins_per_length_[a]);
      at[a] = i < 0 ? 0 : i < bins_[a] ? i : bins_[a] - 1;
    }
    return as_size(at[0]) + as_size(bins_[0]) * (as_size(at[1]) + as_size(bins_[1]) * as_size(at[2]));
  }
  /// From `node` down to the bottom.
  [[nodiscard]] std::size_t descend(std::size_t node, const std::array<float, 3>& at) const noexcept {
    const std::array<float, 4> q{at[0], at[1], at[2], 0.0F};
    const std::size_t bottom = std::size_t{1} << splits_;
    while (node < bottom) {
      const std::uint32_t packed = split_[node];
      node = 2 * node + as_size(q[packed & 3U] >= std::bit_cast<float>(packed & ~3U));
    }
    return node;
  }

  /// Boxes of the four children of a node.
  struct alignas(32) Node {
    std::array<std::array<float, kWidth>, 3> lower;
    std::array<std::array<float, kWidth>, 3> upper;

    [[nodiscard]] unsigned meeting(const std::array<float, 3>& low,
                                   const std::array<float, 3>& high) const noexcept {
      unsigned mask = 0;
      for (unsigned i = 0; i < kWidth; ++i) {
        const bool inside = (high[0] >= lower[0][i]) & (low[0] <= upper[0][i]) & (high[1] >= lower[1][i]) &
                            (low[1] <= upper[1][i]) & (high[2] >= lower[2][i]) & (low[2] <= upper[2][i]);
        mask |= static_cast<unsigned>(inside) << i;
      }
      return mask;
    }
  };

  [[nodiscard]] std::array<float, 3> query(const Vec3& x) const noexcept {
    return {static_cast<float>(x.x - origin_.x), static_cast<float>(x.y - origin_.y),
            static_cast<float>(x.z - origin_.z)};
  }

  std::size_t cell_count_ = 0;
  Vec3 origin_{0.0};
  double margin_ = 0.0;               ///< by which boxes grow
  std::vector<std::uint32_t> order_;  ///< until taken
  std::size_t splits_ = 0;            ///< levels of the k-d tree
  /// Node n has the children 2 n and 2 n + 1, the root is 1. A single-precision number whose two lowest bits
  /// are the axis: it costs nothing that matters to a place to begin at.
  LargeVector<std::uint32_t> split_;
  std::array<int, 3> bins_{1, 1, 1};  ///< along the axes
  std::array<float, 3> bins_per_length_{};
  LargeVector<std::uint32_t> bin_node_;    ///< node of the k-d tree; x fastest
  std::vector<std::vector<Node>> levels_;  ///< [0]: nodes whose children are leaves; back(): the root
};

template <typename Visit>
void CellTree::visit_leaves(const Vec3& lower, const Vec3& upper, Visit&& visit) const noexcept {
  if (levels_.empty()) return;
  struct Pending {
    std::uint32_t node;
    std::uint8_t level;
    std::uint8_t mask;
  };
  constexpr std::size_t kMaxLevels = 20;  // 4^20 leaves: more than any mesh has
  std::array<Pending, kMaxLevels> stack;
  const std::array<float, 3> low = query(lower), high = query(upper);
  std::size_t depth = 0;
  const auto push = [&](std::size_t level, std::size_t node) {
    const unsigned mask = levels_[level][node].meeting(low, high);
    if (mask != 0) {
      stack[depth++] = {static_cast<std::uint32_t>(node), static_cast<std::uint8_t>(level),
                        static_cast<std::uint8_t>(mask)};
    }
  };
  push(levels_.size() - 1, 0);
  while (depth > 0) {
    Pending& top = stack[depth - 1];
    const auto child = static_cast<unsigned>(__builtin_ctz(top.mask));
    const std::size_t node = kWidth * top.node + child;
    const std::size_t level = top.level;
    top.mask = static_cast<std::uint8_t>(top.mask & (top.mask - 1U));
    if (top.mask == 0) --depth;
    if (level > 0) {
      push(level - 1, node);
      continue;
    }
    const std::size_t first = node * kLeafCells;
    const std::size_t last = first + kLeafCells < cell_count_ ? first + kLeafCells : cell_count_;
    if (visit(first, last)) return;
  }
}

}  // namespace palpate
