#include "common/trace/tract/bundle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "common/base/index.h"
#include "common/base/quantile.h"

namespace palpate {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

bool finite(const Vec3& x) noexcept { return std::isfinite(x.x) && std::isfinite(x.y) && std::isfinite(x.z); }

/// Counts the voxels of one piece after another.
class VoxelCounter {
 public:
  VoxelCounter(const TractogramImage& image, BundleDensity& density)
      : size_(image.voxels), density_(density), counted_for_(density.lines.size(), 0) {}

  void begin_line() noexcept { ++line_; }

  /// @param a, b in voxels: centres at whole numbers. False: a part of it lies outside.
  bool pass(const Vec3& a, const Vec3& b) {
    // So far away rounding leaves no voxel of the way between.
    constexpr double kFar = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(a[axis]) > kFar || std::abs(b[axis]) > kFar) return false;
    }
    // The part inside the image.
    double from = 0.0, to = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double low = -0.5, high = size_[axis] - 0.5, step = b[axis] - a[axis];
      if (step == 0.0) {
        if (a[axis] < low || a[axis] > high) return false;
        continue;
      }
      const double at_low = (low - a[axis]) / step, at_high = (high - a[axis]) / step;
      from = std::max(from, std::min(at_low, at_high));
      to = std::min(to, std::max(at_low, at_high));
    }
    if (!(from <= to)) return false;
    walk(a + from * (b - a), a + to * (b - a));
    return from == 0.0 && to == 1.0;
  }

 private:
  void walk(const Vec3& a, const Vec3& b) {
    Index3 voxel = voxel_of(a);
    const Index3 last = voxel_of(b);
    Vec3 next{0.0}, between{0.0};  // parts of the piece up to the next border, and from border to border
    for (int axis = 0; axis < 3; ++axis) {
      const double step = b[axis] - a[axis];
      between[axis] = step != 0.0 ? 1.0 / std::abs(step) : std::numeric_limits<double>::infinity();
      next[axis] = step != 0.0 ? (voxel[axis] + (step > 0.0 ? 0.5 : -0.5) - a[axis]) / step
                               : std::numeric_limits<double>::infinity();
    }
    count(voxel);
    while (voxel != last) {
      // Only along axes that still have a way to go: rounding can neither miss the last voxel nor pass it.
      int axis = -1;
      for (int i = 0; i < 3; ++i) {
        if (voxel[i] != last[i] && (axis < 0 || next[i] < next[axis])) axis = i;
      }
      voxel[axis] += voxel[axis] < last[axis] ? 1 : -1;
      next[axis] += between[axis];
      count(voxel);
    }
  }

  [[nodiscard]] Index3 voxel_of(const Vec3& x) const noexcept {
    Index3 voxel{0};
    for (int axis = 0; axis < 3; ++axis)
      voxel[axis] = static_cast<int>(std::clamp(std::floor(x[axis] + 0.5), 0.0, size_[axis] - 1.0));
    return voxel;
  }

  void count(const Index3& voxel) {
    const std::size_t at =
        as_size(voxel.x) + as_size(size_.x) * (as_size(voxel.y) + as_size(size_.y) * as_size(voxel.z));
    if (std::exchange(counted_for_[at], line_) == line_) return;
    if (density_.lines[at] == 0.0F) ++density_.voxels;
    density_.lines[at] += 1.0F;
  }

  Index3 size_;
  BundleDensity& density_;
  std::vector<std::uint64_t> counted_for_;  // the last line that was counted in each voxel, from 1
  std::uint64_t line_ = 0;
};

/// Places at `count` equal parts of a line's length; none: see BundleProfile::left_out.
std::optional<std::vector<Vec3>> spread_along(std::span<const Vec3f> line, std::size_t count) {
  std::vector<Vec3> points;
  std::vector<double> along{0.0};
  for (const Vec3f& x : line) {
    points.emplace_back(x);
    if (!finite(points.back())) return std::nullopt;
    if (points.size() > 1)
      along.push_back(along.back() + glm::length(points.back() - points[points.size() - 2]));
  }
  if (points.size() < 2 || !(along.back() > 0.0)) return std::nullopt;
  std::vector<Vec3> out;
  std::size_t piece = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double wanted = along.back() * static_cast<double>(i) / static_cast<double>(count - 1);
    while (piece + 2 < points.size() && along[piece + 1] < wanted) ++piece;
    const double length = along[piece + 1] - along[piece];
    const double part = length > 0.0 ? std::clamp((wanted - along[piece]) / length, 0.0, 1.0) : 0.0;
    out.push_back(points[piece] + part * (points[piece + 1] - points[piece]));
  }
  return out;
}

constexpr std::size_t kShapePlaces = 12;
using Shape = std::array<Vec3, kShapePlaces>;

Shape shape_of(const std::vector<Vec3>& spread) {
  Shape shape;
  std::copy(spread.begin(), spread.end(), shape.begin());
  return shape;
}

/// Mean distances of the places of two lines, as they are and with one of them turned.
std::pair<double, double> distances(const Shape& a, const Shape& b) {
  double as_is = 0.0, turned = 0.0;
  for (std::size_t i = 0; i < kShapePlaces; ++i) {
    as_is += glm::length(a[i] - b[i]);
    turned += glm::length(a[i] - b[kShapePlaces - 1 - i]);
  }
  return {as_is / kShapePlaces, turned / kShapePlaces};
}

/// The shape nearest to all others, from its lower end. @pre there are some.
Shape middle_of(const std::vector<Shape>& shapes) {
  double least = std::numeric_limits<double>::infinity();
  Shape middle = shapes.front();
  for (const Shape& candidate : shapes) {
    double sum = 0.0;
    for (const Shape& other : shapes) {
      const auto [as_is, turned] = distances(candidate, other);
      sum += std::min(as_is, turned);
    }
    if (sum < least) middle = candidate;
    least = std::min(least, sum);
  }
  const Vec3 way = middle.back() - middle.front();
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(way[i]) > std::abs(way[axis])) axis = i;
  }
  if (way[axis] < 0.0) std::reverse(middle.begin(), middle.end());
  return middle;
}

BundleNode node_of(const Vec3& sum_of_places, std::size_t lines, std::vector<double> values) {
  BundleNode node;
  node.place = sum_of_places / static_cast<double>(lines);
  node.lines = values.size();
  node.valueless = lines - values.size();
  double mean = 0.0, squares = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (const double value : values) squares += (value - mean) * (value - mean);
  node.mean = values.empty() ? kNan : mean;
  node.deviation = values.size() < 2 ? kNan : std::sqrt(squares / static_cast<double>(values.size() - 1));
  node.lower = quantile(values, 0.25);
  node.median = quantile(values, 0.5);
  node.upper = quantile(values, 0.75);
  return node;
}

}  // namespace

BundleDensity bundle_density(const Tractogram& lines, const TractogramImage& image) {
  BundleDensity density;
  density.lines.resize(as_size(image.voxels.x) * as_size(image.voxels.y) * as_size(image.voxels.z), 0.0F);
  const Mat3 to_voxels = glm::inverse(image.axes);
  VoxelCounter counter(image, density);
  for (std::size_t i = 0; i < lines.line_count(); ++i) {
    counter.begin_line();
    const std::span<const Vec3f> line = lines.line(i);
    bool inside = true;
    for (std::size_t p = 0; p < line.size(); ++p) {
      const Vec3 a = to_voxels * (Vec3(line[p > 0 ? p - 1 : 0]) - image.origin);
      const Vec3 b = to_voxels * (Vec3(line[p]) - image.origin);
      inside = finite(a) && finite(b) && counter.pass(a, b) && inside;
    }
    if (!inside) ++density.outside;
  }
  density.volume = static_cast<double>(density.voxels) * std::abs(glm::determinant(image.axes));
  return density;
}

BundleProfile bundle_profile(const Tractogram& lines, int nodes, const PlaceValue& value) {
  constexpr std::size_t kMostCandidates = 200;
  BundleProfile profile;
  std::vector<Shape> candidates;
  const std::size_t apart =
      std::max<std::size_t>(1, (lines.line_count() + kMostCandidates - 1) / kMostCandidates);
  for (std::size_t i = 0; i < lines.line_count(); ++i) {
    if (i % apart != 0 && !candidates.empty()) continue;
    if (const auto spread = spread_along(lines.line(i), kShapePlaces))
      candidates.push_back(shape_of(*spread));
  }
  if (candidates.empty()) {
    profile.left_out = lines.line_count();
    return profile;
  }
  const Shape middle = middle_of(candidates);
  const auto count = as_size(nodes);
  std::vector<Vec3> places(count, Vec3(0.0));
  std::vector<std::vector<double>> values(count);
  for (std::size_t i = 0; i < lines.line_count(); ++i) {
    auto spread = spread_along(lines.line(i), count);
    if (!spread) {
      ++profile.left_out;
      continue;
    }
    const auto [as_is, turned] = distances(middle, shape_of(*spread_along(lines.line(i), kShapePlaces)));
    if (turned < as_is) {
      std::reverse(spread->begin(), spread->end());
      ++profile.turned;
    }
    ++profile.lines;
    for (std::size_t n = 0; n < count; ++n) {
      places[n] += (*spread)[n];
      const double found = value((*spread)[n]);
      if (std::isfinite(found)) values[n].push_back(found);
    }
  }
  for (std::size_t n = 0; n < count; ++n)
    profile.nodes.push_back(node_of(places[n], profile.lines, std::move(values[n])));
  return profile;
}

}  // namespace palpate
