#include "common/field/tensor/gradient_table.h"

#include <algorithm>
#include <cmath>

#include "common/math/symmetric3.h"

namespace palpate {

Mat3 image_axes(const Mat3& axes) noexcept {
  const Mat3 unit{glm::normalize(axes[0]), glm::normalize(axes[1]), glm::normalize(axes[2])};
  const SymmetricEigen eigen = symmetric_eigen(glm::transpose(unit) * unit);
  Mat3 root{0.0};
  for (int i = 0; i < 3; ++i)
    root += glm::outerProduct(eigen.vectors[i], eigen.vectors[i]) / std::sqrt(eigen.values[i]);
  // Axes that are at right angles already keep their exact directions.
  constexpr double kRightAngles = 1e-12;
  return eigen.values[0] - eigen.values[2] < kRightAngles ? unit : unit * root;
}

Mat3 fsl_axes(const Mat3& axes) noexcept {
  Mat3 directions = image_axes(axes);
  if (glm::determinant(axes) > 0.0) directions[0] = -directions[0];
  return directions;
}

double GradientTable::largest_weighting() const noexcept {
  return weightings.empty() ? 0.0 : *std::max_element(weightings.begin(), weightings.end());
}

bool GradientTable::unweighted(std::size_t i) const noexcept {
  constexpr double kSmall = 0.05;
  return !(weightings[i] > kSmall * largest_weighting()) || directions[i] == Vec3{0.0};
}

std::size_t GradientTable::unweighted_count() const noexcept {
  std::size_t count = 0;
  for (std::size_t i = 0; i < weightings.size(); ++i) count += unweighted(i) ? 1 : 0;
  return count;
}

}  // namespace palpate
