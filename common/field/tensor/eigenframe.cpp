#include "common/field/tensor/eigenframe.h"

namespace palpate {

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
