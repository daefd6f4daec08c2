#include "common/field/grid/image_resample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <utility>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/field/grid/grid_from_data.h"
#include "common/field/grid/lattice_values.h"
#include "common/math/lattice.h"
#include "common/math/power_of_two.h"

namespace palpate {
namespace {

// Points this near to a border, in voxels, are on it: a slice of the outermost layer is not outside.
constexpr double kGridRounding = 1e-6;

/// Whether a grid coordinate lies between the first point and the last one.
bool is_inside(double g, double last) { return g >= -kGridRounding && g <= last + kGridRounding; }

double length_of(const Vec3& v) {
  const double unit = power_of_two(binary_exponent(std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)})));
  return glm::length(v / unit) * unit;
}

/// The step of the image along `direction`, where that is one of its axes; else its shortest step.
double step_along(const UniformTopology& image, const Vec3& direction) {
  constexpr double kParallel = 1.0 - 1e-9;
  double shortest = HUGE_VAL;
  for (int axis = 0; axis < 3; ++axis) {
    const double step = length_of(image.axes[axis]);
    if (std::abs(glm::dot(image.axes[axis] / step, direction)) >= kParallel) return step;
    shortest = std::min(shortest, step);
  }
  return shortest;
}

/// Where the plane meets the edges of the box of all points.
std::vector<Vec3> meeting_points(const UniformTopology& image, const ImagePlane& plane) {
  const Vec3 last(image.points - 1);
  std::vector<Vec3> met;
  double size = 0.0;
  for (int axis = 0; axis < 3; ++axis) size = std::max(size, last[axis] * length_of(image.axes[axis]));
  const double near = kGridRounding * size;
  for (int axis = 0; axis < 3; ++axis) {
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    for (unsigned corner = 0; corner < 4; ++corner) {
      Vec3 g{0.0};
      g[b] = (corner & 1U) != 0 ? last[b] : 0.0;
      g[c] = (corner & 2U) != 0 ? last[c] : 0.0;
      const Vec3 from = image.origin + image.axes * g;
      const Vec3 along = image.axes[axis] * last[axis];
      const double below = plane.offset - glm::dot(plane.normal, from);
      const double rise = glm::dot(plane.normal, along);
      // An edge in the plane meets it at both ends, which other edges may not.
      if (std::abs(below) <= near && std::abs(rise) <= near) {
        met.push_back(from);
        met.push_back(from + along);
      } else if (below * (rise > 0.0 ? 1.0 : -1.0) >= -near &&
                 (below - rise) * (rise > 0.0 ? 1.0 : -1.0) <= near) {
        met.push_back(from + std::clamp(below / rise, 0.0, 1.0) * along);
      }
    }
  }
  return met;
}

}  // namespace

std::optional<UniformTopology> plane_lattice(const UniformTopology& image, const ImagePlane& plane,
                                             std::optional<double> spacing) {
  constexpr double kSteep = 0.9;
  const Vec3 up = std::abs(plane.normal.z) > kSteep ? Vec3(0.0, 1.0, 0.0) : Vec3(0.0, 0.0, 1.0);
  const Vec3 u = glm::normalize(glm::cross(up, plane.normal));
  const Vec3 v = glm::cross(plane.normal, u);
  const std::vector<Vec3> met = meeting_points(image, plane);
  if (met.empty()) return std::nullopt;
  double low_u = HUGE_VAL, high_u = -HUGE_VAL, low_v = HUGE_VAL, high_v = -HUGE_VAL;
  for (const Vec3& x : met) {
    low_u = std::min(low_u, glm::dot(u, x)), high_u = std::max(high_u, glm::dot(u, x));
    low_v = std::min(low_v, glm::dot(v, x)), high_v = std::max(high_v, glm::dot(v, x));
  }
  const double step_u = spacing.value_or(step_along(image, u)),
               step_v = spacing.value_or(step_along(image, v));
  constexpr double kMostPoints = 1e9;
  const auto points = [&](double extent, double step) {
    return static_cast<int>(std::min(kMostPoints, std::floor(extent / step + kGridRounding))) + 1;
  };
  UniformTopology lattice;
  lattice.points = {points(high_u - low_u, step_u), points(high_v - low_v, step_v), 1};
  lattice.origin = low_u * u + low_v * v + plane.offset * plane.normal;
  lattice.axes = Mat3(step_u * u, step_v * v, step_along(image, plane.normal) * plane.normal);
  return lattice;
}

std::optional<IndexBox> points_in(const UniformTopology& image, const Box& box, const LatticeLines* lines) {
  const GridFromData grid(image.axes, image.origin);
  Box reach;
  for (unsigned i = 0; i < 8; ++i) {
    reach.include(
        grid.point({(i & 1U) != 0 ? box.upper.x : box.lower.x, (i & 2U) != 0 ? box.upper.y : box.lower.y,
                    (i & 4U) != 0 ? box.upper.z : box.lower.z}));
  }
  if (lines != nullptr) reach = {lines->grid(reach.lower), lines->grid(reach.upper)};
  IndexBox part;
  for (int axis = 0; axis < 3; ++axis) {
    const double last = image.points[axis] - 1;
    const double from = std::max(0.0, std::ceil(reach.lower[axis] - kGridRounding));
    const double to = std::min(last, std::floor(reach.upper[axis] + kGridRounding));
    if (!(from <= to)) return std::nullopt;
    part.first[axis] = static_cast<int>(from);
    part.last[axis] = static_cast<int>(to);
  }
  return part;
}

UniformTopology part_of(const UniformTopology& image, const IndexBox& part) noexcept {
  return {part.points(), image.origin + image.axes * Vec3(part.first), image.axes};
}

DataArray values_of(const UniformTopology& image, const DataArray& values, const IndexBox& part) {
  const Index3 n = part.points();
  DataArray result = values;
  result.tuples = count_of(n);
  result.sparse = nullptr;
  const std::size_t size = byte_size(values.type) * as_size(values.components), row = as_size(n.x) * size;
  auto bytes = std::make_shared<std::vector<std::byte>>(result.tuples * size);
  std::byte* to = bytes->data();
  for (int k = part.first.z; k <= part.last.z; ++k) {
    for (int j = part.first.y; j <= part.last.y; ++j, to += row) {
      const std::size_t from = index_in(image.points, {part.first.x, j, k});
      for (std::size_t i = 0; values.sparse && i < as_size(n.x); ++i) {
        const float value = (*values.sparse)[from + i];
        std::memcpy(to + i * size, &value, size);
      }
      if (!values.sparse) std::memcpy(to, values.bytes.data() + from * size, row);
    }
  }
  result.bytes = std::as_const(*bytes);
  result.owner = std::move(bytes);
  return result;
}

std::vector<double> values_on(const UniformTopology& image, const DataArray& values, int component,
                              const UniformTopology& lattice, int threads, const LatticeLines* lines) {
  const Index3 n = image.points, m = lattice.points;
  PALPATE_CHECK(values.tuples == count_of(n) && component >= 0 && component < values.components);
  const GridFromData grid(image.axes, image.origin);
  const Vec3 start = grid.point(lattice.origin);
  const Mat3 step(grid.direction(lattice.axes[0]), grid.direction(lattice.axes[1]),
                  grid.direction(lattice.axes[2]));
  const auto at = [&](const Index3& p) { return values.at(index_in(n, p), component); };
  const auto sample = [&](Vec3 g) {
    if (lines != nullptr) g = lines->grid(g);
    Index3 low{0};
    Vec3 part{0.0};
    for (int axis = 0; axis < 3; ++axis) {
      const double last = n[axis] - 1;
      if (!is_inside(g[axis], last)) return std::nan("");
      g[axis] = std::clamp(g[axis], 0.0, last);
      // On a point the others have no say.
      if (std::abs(g[axis] - std::round(g[axis])) <= kGridRounding) g[axis] = std::round(g[axis]);
      low[axis] = static_cast<int>(std::floor(g[axis]));
      part[axis] = g[axis] - low[axis];
    }
    double sum = 0.0;
    for (unsigned corner = 0; corner < 8; ++corner) {
      Index3 p = low;
      double weight = 1.0;
      for (int axis = 0; axis < 3; ++axis) {
        const bool far = ((corner >> static_cast<unsigned>(axis)) & 1U) != 0;
        weight *= far ? part[axis] : 1.0 - part[axis];
        p[axis] += far ? 1 : 0;
      }
      if (weight > 0.0) sum += weight * at(p);
    }
    return std::isfinite(sum) ? sum : std::nan("");
  };

  std::vector<double> result(count_of(m));
  const auto row = as_size(m.x);
  const std::size_t rows = row > 0 ? result.size() / row : 0;
  parallel_for(rows, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t r = first; r < last; ++r) {
      const auto j = static_cast<int>(r % as_size(m.y));
      const auto k = static_cast<int>(r / as_size(m.y));
      for (int i = 0; i < m.x; ++i) result[r * row + as_size(i)] = sample(start + step * Vec3(i, j, k));
    }
  });
  return result;
}

ResampledImage resample(const UniformTopology& image, const DataArray& values, int component,
                        const UniformTopology& lattice, float filler, int threads,
                        const LatticeLines* lines) {
  ResampledImage result;
  for (const double value : values_on(image, values, component, lattice, threads, lines)) {
    result.outside += std::isnan(value) ? 1 : 0;
    result.values.push_back(std::isnan(value) ? filler : static_cast<float>(value));
  }
  return result;
}

NearestPoints nearest_points(const UniformTopology& image, const UniformTopology& lattice,
                             const LatticeLines* lines) {
  const GridFromData grid(image.axes, image.origin);
  const Vec3 start = grid.point(lattice.origin);
  const Mat3 step(grid.direction(lattice.axes[0]), grid.direction(lattice.axes[1]),
                  grid.direction(lattice.axes[2]));
  const Index3 m = lattice.points;
  NearestPoints nearest;
  nearest.index.reserve(count_of(m));
  for (int k = 0; k < m.z; ++k) {
    for (int j = 0; j < m.y; ++j) {
      for (int i = 0; i < m.x; ++i) {
        const Vec3 mean = start + step * Vec3(i, j, k);
        const Vec3 g = lines != nullptr ? lines->grid(mean) : mean;
        Index3 point{0};
        bool inside = true, exact = true;
        for (int axis = 0; axis < 3; ++axis) {
          const double last = image.points[axis] - 1;
          inside = inside && is_inside(g[axis], last);
          if (!inside) break;
          const double whole = std::clamp(std::round(g[axis]), 0.0, last);
          exact = exact && std::abs(g[axis] - whole) <= kGridRounding;
          point[axis] = static_cast<int>(whole);
        }
        nearest.outside += inside ? 0 : 1;
        nearest.exact = nearest.exact && exact;
        nearest.index.push_back(inside ? index_in(image.points, point) : NearestPoints::kBeyond);
      }
    }
  }
  return nearest;
}

DataArray values_at(const DataArray& values, const NearestPoints& points, std::span<const std::byte> beyond) {
  const std::size_t size = byte_size(values.type) * as_size(values.components);
  PALPATE_CHECK(!values.sparse && beyond.size() == size);
  const auto bytes = std::make_shared<std::vector<std::byte>>(points.index.size() * size);
  std::byte* to = bytes->data();
  for (const std::size_t index : points.index) {
    const bool there = index != NearestPoints::kBeyond;
    to = std::ranges::copy(there ? values.bytes.subspan(index * size, size) : beyond, to).out;
  }
  DataArray result = values;
  result.tuples = points.index.size();
  result.bytes = std::as_const(*bytes);
  result.owner = bytes;
  return result;
}

}  // namespace palpate
