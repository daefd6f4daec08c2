#include "loaders/cardiac/element_frames.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/math/symmetric3.h"
#include "common/math/vec.h"

namespace palpate {
namespace {

constexpr std::size_t kCorners = 4, kNumbers = 9;
/// Corners of the edges whose middles the points behind the corners are, in VTK's order.
constexpr std::array<std::pair<std::size_t, std::size_t>, 6> kEdges{
    {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};

/// Outer products at the corners; false where a direction is zero or NaN.
bool corner_products(std::span<const double> places, std::size_t direction,
                     std::array<Mat3, kCorners>& corners) {
  const double a = (5.0 + 3.0 * std::sqrt(5.0)) / 20.0, b = (5.0 - std::sqrt(5.0)) / 20.0;
  Mat3 sum{0.0};
  for (std::size_t i = 0; i < kCorners; ++i) {
    const std::size_t at = i * kNumbers + 3 * direction;
    const Vec3 v{places[at], places[at + 1], places[at + 2]};
    const double length = glm::length(v);
    if (!(length > 0.0) || !std::isfinite(length)) return false;
    corners[i] = glm::outerProduct(v / length, v / length);
    sum += corners[i];
  }
  for (Mat3& corner : corners) corner = (corner - b * sum) / (a - b);
  return true;
}

}  // namespace

void add_point_frames(std::span<const double> further, const UnstructuredTopology& topology, DataSet& mesh,
                      std::vector<std::string>& notes) {
  const std::size_t points = topology.positions.tuples, elements = topology.types.size();
  const auto place = [&](std::int64_t p) {
    return Vec3{topology.positions.at(as_size(p), 0), topology.positions.at(as_size(p), 1),
                topology.positions.at(as_size(p), 2)};
  };
  static constexpr std::array<const char*, 3> kNames{"fibre", "sheet", "normal"};
  std::size_t without = 0;
  for (std::size_t direction = 0; direction < kNames.size(); ++direction) {
    std::vector<Mat3> sums(points, Mat3{0.0});
    std::vector<double> weights(points, 0.0);
    for (std::size_t e = 0; e < elements; ++e) {
      std::array<Mat3, kCorners> corners{};
      if (!corner_products(further.subspan(e * kCorners * kNumbers, kCorners * kNumbers), direction,
                           corners)) {
        without += direction == 0 ? 1 : 0;
        continue;
      }
      const auto first = topology.connectivity.begin() + topology.offsets[e];
      const Vec3 x0 = place(first[0]);
      const double volume =
          std::abs(glm::dot(glm::cross(place(first[1]) - x0, place(first[2]) - x0), place(first[3]) - x0));
      const auto add = [&](std::int64_t point, const Mat3& product) {
        sums[as_size(point)] += volume * product;
        weights[as_size(point)] += volume;
      };
      for (std::size_t i = 0; i < kCorners; ++i) add(first[static_cast<std::ptrdiff_t>(i)], corners[i]);
      const auto count = as_size(topology.offsets[e + 1] - topology.offsets[e]);
      for (std::size_t m = kCorners; m < count; ++m) {
        const auto [i, j] = kEdges[m - kCorners];
        add(first[static_cast<std::ptrdiff_t>(m)], 0.5 * (corners[i] + corners[j]));
      }
    }
    std::vector<double> values;
    values.reserve(3 * points);
    for (std::size_t p = 0; p < points; ++p) {
      Vec3 v{std::numeric_limits<double>::quiet_NaN()};
      if (weights[p] > 0.0) v = symmetric_eigen(sums[p] / weights[p]).vectors[0];
      values.insert(values.end(), {v.x, v.y, v.z});
    }
    mesh.arrays.push_back(
        make_array(kNames[direction], Association::kPoint, 3, std::span<const double>(values)));
  }
  notes.push_back(
      "5 directions in each element: those at its four quadrature points brought to the points, linearly");
  if (without > 0)
    notes.push_back(counted(without, "element") +
                    " without a fibre direction at a quadrature point: left out of the mean");
}

}  // namespace palpate
