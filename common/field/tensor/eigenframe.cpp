#include "common/field/tensor/eigenframe.h"

#include <algorithm>
#include <cmath>

#include "common/math/symmetric3.h"

namespace palpate {
namespace {

template <typename Function>
Mat3 with_values(const SymmetricEigen& eigen, const Function& function) noexcept {
  Mat3 result{0.0};
  for (int i = 0; i < 3; ++i) {
    result += function(eigen.values[i]) * glm::outerProduct(eigen.vectors[i], eigen.vectors[i]);
  }
  return result;
}

}  // namespace

Mat3 symmetric_log(const Mat3& tensor, double floor) noexcept {
  return with_values(symmetric_eigen(tensor), [&](double value) { return std::log(std::max(value, floor)); });
}

Mat3 symmetric_exp(const Mat3& tensor) noexcept {
  return with_values(symmetric_eigen(tensor), [](double value) { return std::exp(value); });
}

Mat3 without_negative(const Mat3& tensor) noexcept {
  return with_values(symmetric_eigen(tensor), [](double value) { return std::max(value, 0.0); });
}

EigenGaps eigen_gaps(const Vec3& eigenvalues) noexcept {
  const auto positive = [](double value) { return value > 0.0 ? value : 0.0; };
  const Vec3 values{positive(eigenvalues.x), positive(eigenvalues.y), positive(eigenvalues.z)};
  if (values.x == 0.0) return {};
  return {.major = (values.x - values.y) / values.x, .minor = (values.y - values.z) / values.x};
}

Mat3 carried_frame(const Mat3& frame, const Mat3& before) noexcept {
  Mat3 carried = frame;
  for (int axis = 0; axis < 2; ++axis) {
    if (glm::dot(frame[axis], before[axis]) < 0.0) carried[axis] = -frame[axis];
  }
  carried[2] = glm::cross(carried[0], carried[1]);
  return carried;
}

void DirectionMean::add(const Vec3& direction, double weight) noexcept {
  const Vec3 unit = glm::normalize(direction);
  sum_ += weight * glm::outerProduct(unit, unit);
}

DirectionMean::Result DirectionMean::result() const noexcept {
  const SymmetricEigen eigen = symmetric_eigen(sum_);
  if (!(eigen.values[0] > 0.0)) return {};
  return {.direction = eigen.vectors[0], .gap = (eigen.values[0] - eigen.values[1]) / eigen.values[0]};
}

}  // namespace palpate
