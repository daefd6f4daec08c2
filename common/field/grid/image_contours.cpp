#include "common/field/grid/image_contours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include "common/base/check.h"
#include "common/base/index.h"

namespace palpate {
namespace {

/// An edge between points: 2 p for the one from point p along the first axis, 2 p + 1 along the second one.
using EdgeId = std::int64_t;

class Squares {
 public:
  Squares(const UniformTopology& lattice, std::span<const float> values, double value)
      : lattice_(lattice),
        values_(values),
        value_(value),
        columns_(lattice.points.x),
        rows_(lattice.points.y) {}

  /// The pairs of edges that lines join, square by square.
  [[nodiscard]] std::vector<std::array<EdgeId, 2>> pieces() const {
    std::vector<std::array<EdgeId, 2>> found;
    for (int j = 0; j + 1 < rows_; ++j) {
      for (int i = 0; i + 1 < columns_; ++i) add_pieces(i, j, found);
    }
    return found;
  }

  [[nodiscard]] ContourPoint crossing(EdgeId edge) const {
    const auto point = static_cast<int>(edge / 2);
    const int i = point % columns_, j = point / columns_;
    const int along_x = edge % 2 == 0 ? 1 : 0, along_y = 1 - along_x;
    const double a = at(i, j), b = at(i + along_x, j + along_y);
    const double part = (value_ - a) / (b - a);
    const double before = bend(at(i - along_x, j - along_y), a, b);
    const double after = bend(a, b, at(i + 2 * along_x, j + 2 * along_y));
    constexpr double kSingle = std::numeric_limits<float>::epsilon();
    const double rounding = kSingle * std::max(std::abs(a), std::abs(b));
    const double off = std::min(1.0, (std::max(before, after) / 8.0 + rounding) / std::abs(b - a));
    const Vec3 g(i + along_x * part, j + along_y * part, 0.0);
    const double step = glm::length(lattice_.axes[along_x == 1 ? 0 : 1]);
    return {lattice_.origin + lattice_.axes * g, off * step};
  }

 private:
  /// NaN beyond the border.
  [[nodiscard]] double at(int i, int j) const {
    if (i < 0 || j < 0 || i >= columns_ || j >= rows_) return std::nan("");
    return static_cast<double>(values_[as_size(j) * as_size(columns_) + as_size(i)]);
  }

  /// h^2 |f''| at the middle one of three points; 0 where one is missing.
  static double bend(double a, double b, double c) {
    const double second = std::abs(a - 2.0 * b + c);
    return std::isfinite(second) ? second : 0.0;
  }

  void add_pieces(int i, int j, std::vector<std::array<EdgeId, 2>>& found) const {
    // Corners and the edges from each to the next, counter-clockwise.
    const std::array<double, 4> v{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
    if (!std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); })) return;
    const EdgeId here = 2 * (static_cast<EdgeId>(j) * columns_ + i);
    const std::array<EdgeId, 4> edges{here, here + 3, here + EdgeId{2} * columns_, here + 1};
    std::array<EdgeId, 4> crossed{};
    std::size_t count = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      if ((v[k] >= value_) != (v[(k + 1) % 4] >= value_)) crossed[count++] = edges[k];
    }
    if (count == 2) found.push_back({crossed[0], crossed[1]});
    if (count < 4) return;
    // The bilinear values part at their saddle: lines cut off the corners that are on the other side of it.
    const double saddle = (v[0] * v[2] - v[1] * v[3]) / (v[0] + v[2] - v[1] - v[3]);
    const bool joined = (saddle >= value_) == (v[0] >= value_);
    if (joined) {
      found.push_back({edges[0], edges[1]});
      found.push_back({edges[2], edges[3]});
    } else {
      found.push_back({edges[3], edges[0]});
      found.push_back({edges[1], edges[2]});
    }
  }

  const UniformTopology& lattice_;
  std::span<const float> values_;
  double value_;
  int columns_, rows_;
};

}  // namespace

std::vector<ContourLine> contour_lines(const UniformTopology& lattice, std::span<const float> values,
                                       double value) {
  PALPATE_CHECK(lattice.points.z == 1);
  PALPATE_CHECK(values.size() == as_size(lattice.points.x) * as_size(lattice.points.y));
  const Squares squares(lattice, values, value);
  const std::vector<std::array<EdgeId, 2>> pieces = squares.pieces();
  // An edge lies between two squares at most, and each has one piece that ends there.
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::unordered_map<EdgeId, std::array<std::size_t, 2>> at_edge;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    for (const EdgeId edge : pieces[p]) {
      auto& both = at_edge.try_emplace(edge, std::array{kNone, kNone}).first->second;
      both[both[0] == kNone ? 0 : 1] = p;
    }
  }
  std::vector<bool> used(pieces.size());
  const auto follow = [&](std::size_t piece, EdgeId from) {
    ContourLine line{squares.crossing(from)};
    while (piece != kNone && !used[piece]) {
      used[piece] = true;
      from = pieces[piece][0] == from ? pieces[piece][1] : pieces[piece][0];
      line.push_back(squares.crossing(from));
      const auto& both = at_edge.at(from);
      piece = both[0] == piece ? both[1] : both[0];
    }
    return line;
  };
  std::vector<ContourLine> lines;
  // Lines that end somewhere, then rings.
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    for (const EdgeId edge : pieces[p]) {
      if (!used[p] && at_edge.at(edge)[1] == kNone) lines.push_back(follow(p, edge));
    }
  }
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    if (!used[p]) lines.push_back(follow(p, pieces[p][0]));
  }
  return lines;
}

}  // namespace palpate
