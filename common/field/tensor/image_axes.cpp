#include "common/field/tensor/image_axes.h"

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

}  // namespace palpate
