#include "common/kinematics/tracker_correction.h"

#include <algorithm>
#include <array>

#include "common/base/index.h"

namespace palpate {

PoseError ErrorTable::at(const Vec3& p) const noexcept {
  if (values.empty()) return {};
  std::array<std::size_t, 3> first{};
  Vec3 u{0.0};
  for (int axis = 0; axis < 3; ++axis) {
    const double last = count[axis] - 1;
    // NaN compares false and ends at the first node: a table never reads outside itself.
    const double g = (p[axis] - lower[axis]) / spacing[axis];
    const double held = g > 0.0 ? std::min(g, last) : 0.0;
    const double cell = std::min(std::floor(held), last - 1.0);
    first[as_size(axis)] = floor_size(cell);
    u[axis] = held - cell;
  }
  const auto nx = as_size(count.x), ny = as_size(count.y);
  PoseError sum;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const std::size_t i = corner & 1U, j = (corner >> 1U) & 1U, k = corner >> 2U;
    const double weight = (i ? u.x : 1.0 - u.x) * (j ? u.y : 1.0 - u.y) * (k ? u.z : 1.0 - u.z);
    sum = sum + weight * values[((first[2] + k) * ny + first[1] + j) * nx + first[0] + i];
  }
  return sum;
}

PoseError ErrorSpline::at(const Vec3& p) const noexcept {
  PoseError sum = plane[0] + p.x * plane[1] + p.y * plane[2] + p.z * plane[3];
  for (std::size_t i = 0; i < centers.size(); ++i) sum = sum + glm::distance(p, centers[i]) * weights[i];
  return sum;
}

void monomials(const Vec3& u, int degree, std::span<double> values) noexcept {
  std::size_t term = 0;
  double x = 1.0;
  for (int s = 0; s <= degree; ++s, x *= u.x) {
    double xy = x;
    for (int t = 0; t <= degree - s; ++t, xy *= u.y) {
      double xyz = xy;
      for (int w = 0; w <= degree - s - t; ++w, xyz *= u.z) values[term++] = xyz;
    }
  }
}

Vec3 VectorPolynomial::at(const Vec3& p) const noexcept {
  if (degree < 0) return Vec3{0.0};
  std::array<double, kMaxTerms> values{};
  const auto terms = as_size(term_count(degree));
  monomials((p - center) / scale, degree, std::span(values).first(terms));
  Vec3 sum{0.0};
  for (std::size_t j = 0; j < terms; ++j) sum += values[j] * coefficients[j];
  return sum;
}

PoseError pose_error(const TrackerPose& actual, const TrackerPose& reported) noexcept {
  return {actual.position - reported.position,
          short_vector_part(actual.orientation * glm::conjugate(reported.orientation))};
}

PoseError TrackerCorrection::error_at(const Vec3& reported) const noexcept {
  PoseError error{position.at(reported), orientation.at(reported)};
  if (!table.values.empty()) error = error + table.at(reported);
  if (!spline.centers.empty()) error = error + spline.at(reported);
  return error;
}

TrackerPose TrackerCorrection::corrected(const TrackerPose& reported) const noexcept {
  const PoseError error = error_at(reported.position);
  return {reported.position + error.position,
          glm::normalize(rotation_with_vector_part(error.orientation) * reported.orientation)};
}

}  // namespace palpate
