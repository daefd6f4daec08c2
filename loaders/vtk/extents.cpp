#include "loaders/vtk/extents.h"

#include <algorithm>
#include <sstream>

#include "loaders/vtk/saturated.h"

namespace palpate {
namespace {

/// Cells first to end - 1 along each axis.
struct CellBox {
  std::array<std::int64_t, 3> first{};
  std::array<std::int64_t, 3> end{};
};

bool overlap(const CellBox& a, const CellBox& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (a.first[axis] >= b.end[axis] || b.first[axis] >= a.end[axis]) return false;
  }
  return true;
}

bool contains(const CellBox& outer, const CellBox& inner) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (outer.first[axis] > inner.first[axis] || outer.end[axis] < inner.end[axis]) return false;
  }
  return true;
}

/// An axis along which the whole has one point has one cell; along others such pieces have none.
CellBox box_of(const Extent& extent, const Extent& whole) {
  CellBox box{extent.first, extent.last};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (whole.points(axis) == 1) ++box.end[axis];
  }
  return box;
}

/// Counts what no piece covers by halving the box along the pieces' faces.
class Cover {
 public:
  /// Cells of `box` outside of `pieces`, all of which overlap it.
  std::uint64_t left_out(const CellBox& box, const std::vector<CellBox>& pieces) {
    work_ += 1 + pieces.size();
    if (work_ > kMostWork) return 0;
    if (pieces.empty()) {
      std::uint64_t cells = 1;
      for (std::size_t axis = 0; axis < 3; ++axis)
        cells = times(cells, static_cast<std::uint64_t>(box.end[axis] - box.first[axis]));
      return cells;
    }
    for (const CellBox& piece : pieces) {
      if (contains(piece, box)) return 0;
    }
    // The axis with most faces inside the box, at the middle one.
    std::size_t best = 0;
    std::array<std::vector<std::int64_t>, 3> faces;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const CellBox& piece : pieces) {
        for (const std::int64_t at : {piece.first[axis], piece.end[axis]}) {
          if (at > box.first[axis] && at < box.end[axis]) faces[axis].push_back(at);
        }
      }
      if (faces[axis].size() > faces[best].size()) best = axis;
    }
    const auto middle = faces[best].begin() + static_cast<std::ptrdiff_t>(faces[best].size() / 2);
    std::nth_element(faces[best].begin(), middle, faces[best].end());
    CellBox low = box, high = box;
    low.end[best] = *middle;
    high.first[best] = *middle;
    std::uint64_t sum = 0;
    for (const CellBox& half : {low, high}) {
      std::vector<CellBox> inside;
      std::copy_if(pieces.begin(), pieces.end(), std::back_inserter(inside),
                   [&half](const CellBox& piece) { return overlap(piece, half); });
      if (__builtin_add_overflow(sum, left_out(half, inside), &sum)) sum = kHuge;
    }
    return sum;
  }

  [[nodiscard]] bool gave_up() const noexcept { return work_ > kMostWork; }

 private:
  static constexpr std::uint64_t kMostWork = 200'000'000;
  std::uint64_t work_ = 0;
};

}  // namespace

std::uint64_t Extent::points(std::size_t axis) const noexcept {
  return static_cast<std::uint64_t>(last[axis] - first[axis] + 1);
}

std::uint64_t Extent::points() const noexcept { return times(times(points(0), points(1)), points(2)); }

std::uint64_t Extent::cells() const noexcept {
  std::uint64_t cells = 1;
  for (std::size_t axis = 0; axis < 3; ++axis)
    cells = times(cells, points(axis) <= 1 ? points(axis) : points(axis) - 1);
  return cells;
}

std::optional<Extent> extent_of(const std::string& text) {
  std::istringstream stream(text);
  Extent extent;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::int64_t& first = extent.first[axis];
    std::int64_t& last = extent.last[axis];
    if (!(stream >> first >> last)) return std::nullopt;
    constexpr std::int64_t kLargest = 2'147'483'647;
    if (first < -kLargest || last > kLargest || last < first - 1) return std::nullopt;
  }
  return extent;
}

std::optional<std::uint64_t> cells_left_out(const Extent& whole, const std::vector<Extent>& pieces) {
  if (whole.cells() == 0) return 0;
  const CellBox box = box_of(whole, whole);
  std::vector<CellBox> boxes;
  for (const Extent& extent : pieces) {
    const CellBox piece = box_of(extent, whole);
    if (piece.first[0] < piece.end[0] && piece.first[1] < piece.end[1] && piece.first[2] < piece.end[2] &&
        overlap(piece, box)) {
      boxes.push_back(piece);
    }
  }
  Cover cover;
  const std::uint64_t cells = cover.left_out(box, boxes);
  if (cover.gave_up()) return std::nullopt;
  return cells;
}

}  // namespace palpate
