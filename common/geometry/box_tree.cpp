#include "common/geometry/box_tree.h"

#include <numeric>
#include <stdexcept>

namespace palpate {

BoxTree::BoxTree(std::span<const Box> boxes) {
  if (boxes.size() > kMost) throw std::length_error("a tree holds 2^30 boxes at most");
  if (boxes.empty()) return;
  order_.resize(boxes.size());
  std::iota(order_.begin(), order_.end(), 0U);
  std::vector<Vec3> middles;
  middles.reserve(boxes.size());
  for (const Box& box : boxes) middles.push_back(box.center());
  nodes_.reserve(boxes.size());
  build(boxes, middles, 0, static_cast<std::uint32_t>(boxes.size()));
  nodes_.shrink_to_fit();
}

void BoxTree::renumber() noexcept { std::iota(order_.begin(), order_.end(), 0U); }

void BoxTree::build(std::span<const Box> boxes, std::span<const Vec3> middles, std::uint32_t first,
                    std::uint32_t count) {
  const std::size_t here = nodes_.size();
  nodes_.emplace_back();
  Box box, inner;
  for (std::uint32_t i = first; i < first + count; ++i) {
    box.include(boxes[order_[i]].lower);
    box.include(boxes[order_[i]].upper);
    inner.include(middles[order_[i]]);
  }
  nodes_[here].box = box;
  if (count <= kLeaf) {
    nodes_[here].first = first;
    nodes_[here].count = count;
    return;
  }
  const Vec3 size = inner.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::uint32_t half = count / 2;
  const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(first);
  std::nth_element(begin, begin + static_cast<std::ptrdiff_t>(half),
                   begin + static_cast<std::ptrdiff_t>(count), [&](std::uint32_t a, std::uint32_t b) {
                     const double x = middles[a][axis], y = middles[b][axis];
                     return x != y ? x < y : a < b;
                   });
  build(boxes, middles, first, half);
  nodes_[here].second = static_cast<std::uint32_t>(nodes_.size());
  build(boxes, middles, first + half, count - half);
}

}  // namespace palpate
