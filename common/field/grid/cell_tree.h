/// Bounding-volume tree over the cells of a tetrahedral mesh: which cells may hold a point.
///
/// Cells are put in the order of a k-d tree (halving the longest side of the centres' box), so that runs of
/// kLeafCells neighbours are compact; the tree over these runs is then complete and needs no links: node n
/// of a level covers nodes 4 n … 4 n + 3 of the level below. Boxes are stored in single precision, relative
/// to the mesh's lower corner and rounded outwards.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

class CellTree {
 public:
  using Tet = std::array<std::uint32_t, 4>;
  static constexpr std::size_t kLeafCells = 4;
  static constexpr std::size_t kWidth = 4;

  /// The order of cells that the tree wants: a permutation of their indices.
  [[nodiscard]] static std::vector<std::uint32_t> order(std::span<const Vec3> points,
                                                        std::span<const Tet> cells, int threads);

  CellTree() = default;
  /// @pre `cells` are in the order of order().
  CellTree(std::span<const Vec3> points, std::span<const Tet> cells, const Box& bounds, int threads);

  /// The first cell of a leaf whose box holds `x`, or which lies near; follows one path. @rt Safe.
  [[nodiscard]] std::size_t near(const Vec3& x) const noexcept;

  /// Calls `visit(first, last)` for the cells of every leaf whose box holds `x`, until it returns true.
  /// @rt Safe.
  template <typename Visit>
  void visit_leaves(const Vec3& x, Visit&& visit) const noexcept;

 private:
  /// Boxes of the four children of a node.
  struct alignas(32) Node {
    std::array<std::array<float, kWidth>, 3> lower;
    std::array<std::array<float, kWidth>, 3> upper;

    [[nodiscard]] unsigned holding(const std::array<float, 3>& x) const noexcept {
      unsigned mask = 0;
      for (unsigned i = 0; i < kWidth; ++i) {
        const bool inside = (x[0] >= lower[0][i]) & (x[0] <= upper[0][i]) & (x[1] >= lower[1][i]) &
                            (x[1] <= upper[1][i]) & (x[2] >= lower[2][i]) & (x[2] <= upper[2][i]);
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
  std::vector<std::vector<Node>> levels_;  ///< [0]: nodes whose children are leaves; back(): the root
};

template <typename Visit>
void CellTree::visit_leaves(const Vec3& x, Visit&& visit) const noexcept {
  if (levels_.empty()) return;
  struct Pending {
    std::uint32_t node;
    std::uint8_t level;
    std::uint8_t mask;
  };
  constexpr std::size_t kMaxLevels = 20;  // 4^20 leaves: more than any mesh has
  std::array<Pending, kMaxLevels> stack;
  const std::array<float, 3> q = query(x);
  std::size_t depth = 0;
  const auto push = [&](std::size_t level, std::size_t node) {
    const unsigned mask = levels_[level][node].holding(q);
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
