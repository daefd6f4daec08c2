/// A tree of boxes over many small things, such as segments and triangles, for searches of bounded work.
///
/// Things are halved by the median of their middles along the longest side until four are left, so that the
/// tree is no deeper than log2(n) + 1 whatever lies where. A search counts the nodes that it looks at, ends when
/// they are spent and says so: it neither allocates nor throws.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

class BoxTree {
 public:
  static constexpr std::uint32_t kNone = 0xffff'ffffU;
  static constexpr std::size_t kMost = std::size_t{1} << 30;  ///< things

  /// What a search came to.
  struct Found {
    std::uint32_t thing = kNone;  ///< kNone: there is none
    double value = 0.0;           ///< its distance, or the part of the way at which it is met
    int visits = 0;               ///< nodes and things that were looked at
    bool complete = true;         ///< false: the visits were spent before all was looked at
    double unseen = HUGE_VAL;     ///< nothing that was not looked at has a smaller value
  };

  BoxTree() = default;
  /// @param boxes of the things, finite, kMost at most.
  explicit BoxTree(std::span<const Box> boxes);

  [[nodiscard]] bool empty() const noexcept { return nodes_.empty(); }
  /// Things as they lie side by side in the tree.
  [[nodiscard]] std::span<const std::uint32_t> order() const noexcept { return order_; }
  /// The things have been put into that order, and are called by their places in it from now on.
  void renumber() noexcept;
  /// Around all things; empty where there are none.
  [[nodiscard]] Box bounds() const noexcept { return nodes_.empty() ? Box{} : nodes_.front().box; }

  /// The thing nearest to `x`, no farther than `reach`.
  /// @param distance of a thing from `x`, called as distance(std::uint32_t) -> double. @rt Safe where that is.
  template <typename Distance>
  [[nodiscard]] Found nearest(const Vec3& x, double reach, int most_visits,
                              const Distance& distance) const noexcept;

  /// The thing that is met first on the straight way from `a` to `b`.
  /// @param meet the part of the way, from 0 to 1, at which it meets a thing, called as meet(std::uint32_t) -> double;
  /// above 1: it does not. @rt Safe where that is.
  template <typename Meet>
  [[nodiscard]] Found first_met(const Vec3& a, const Vec3& b, int most_visits,
                                const Meet& meet) const noexcept;

 private:
  struct Node {
    Box box;
    std::uint32_t second = 0;  ///< the other child; the first one is the next node
    std::uint32_t first = 0;   ///< of a leaf: where its things begin in order_
    std::uint32_t count = 0;   ///< of a leaf; 0: there are children
  };
  struct Waiting {
    std::uint32_t node;
    double least;  ///< nothing in it is nearer
  };
  static constexpr std::uint32_t kLeaf = 4;
  static constexpr std::size_t kDeepest = 40;

  void build(std::span<const Box> boxes, std::span<const Vec3> middles, std::uint32_t first,
             std::uint32_t count);
  /// @param bound of a box: nothing in it has a smaller value. @param value of a thing. @param best above it
  /// nothing counts.
  template <typename Bound, typename Value>
  [[nodiscard]] Found search(double best, int most_visits, const Bound& bound,
                             const Value& value) const noexcept;

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

template <typename Bound, typename Value>
BoxTree::Found BoxTree::search(double best, int most_visits, const Bound& bound,
                               const Value& value) const noexcept {
  Found found;
  found.value = best;
  if (nodes_.empty()) return found;
  std::array<Waiting, kDeepest> waiting;
  std::size_t depth = 0;
  waiting[depth++] = {0, bound(nodes_.front().box)};
  while (depth > 0) {
    const Waiting next = waiting[--depth];
    if (next.least > found.value) continue;
    if (found.visits >= most_visits) {
      found.complete = false;
      found.unseen = next.least;
      for (std::size_t i = 0; i < depth; ++i) found.unseen = std::min(found.unseen, waiting[i].least);
      return found;
    }
    ++found.visits;
    const Node& node = nodes_[next.node];
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const std::uint32_t thing = order_[node.first + i];
      const double there = value(thing);
      ++found.visits;
      // Of several at the same value the first in the order of the things: no matter how the tree lies.
      if (there > found.value || (there == found.value && thing > found.thing)) continue;
      found.value = there;
      found.thing = thing;
    }
    if (node.count > 0) continue;
    Waiting near{next.node + 1, bound(nodes_[next.node + 1].box)};
    Waiting far{node.second, bound(nodes_[node.second].box)};
    if (far.least < near.least) std::swap(near, far);
    waiting[depth++] = far;
    waiting[depth++] = near;
  }
  return found;
}

template <typename Distance>
BoxTree::Found BoxTree::nearest(const Vec3& x, double reach, int most_visits,
                                const Distance& distance) const noexcept {
  const auto from_box = [&x](const Box& box) { return glm::length(x - glm::clamp(x, box.lower, box.upper)); };
  return search(reach, most_visits, from_box, distance);
}

template <typename Meet>
BoxTree::Found BoxTree::first_met(const Vec3& a, const Vec3& b, int most_visits,
                                  const Meet& meet) const noexcept {
  const Vec3 way = b - a;
  const auto enters = [&](const Box& box) {
    constexpr double kNever = 2.0;
    double from = 0.0, to = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      if (way[axis] == 0.0) {
        if (a[axis] < box.lower[axis] || a[axis] > box.upper[axis]) return kNever;
        continue;
      }
      const double one = (box.lower[axis] - a[axis]) / way[axis];
      const double other = (box.upper[axis] - a[axis]) / way[axis];
      from = std::max(from, std::min(one, other));
      to = std::min(to, std::max(one, other));
    }
    // What touches a box in a corner is not lost by rounding.
    constexpr double kSlack = 1e-12;
    return from <= to + kSlack ? from - kSlack : kNever;
  };
  return search(1.0, most_visits, enters, meet);
}

}  // namespace palpate
