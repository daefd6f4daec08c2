/// Thresholds of the isosurface searches, relative to the size and the values of a field.
#pragma once

#include <algorithm>
#include <cmath>

#include "common/field/scalar_field.h"

namespace palpate {

struct IsosurfaceScale {
  double distance = 0.0;  ///< frame L: what rounding moves a point
  double value = 0.0;     ///< local: what rounding changes a value
  double flat = 0.0;      ///< local: a cell over which s changes by less has no gradient
  double diagonal = 0.0;  ///< frame L

  explicit IsosurfaceScale(const ScalarField& field) {
    const double to_local = power_of_two(-field.frame().length_exponent);
    const Vec3 farthest = glm::max(glm::abs(field.bounds().lower), glm::abs(field.bounds().upper)) * to_local;
    diagonal = field.diagonal() * to_local;
    distance = 0x1p-50 * std::max({farthest.x, farthest.y, farthest.z, diagonal});
    const double largest =
        std::max(std::abs(field.lowest()), std::abs(field.highest())) * field.value_scale();
    value = 0x1p-50 * largest;
    flat = 0x1p-40 * field.local_range();
  }

  /// A path has changed sides when it is beyond the level by more than this.
  [[nodiscard]] double beyond() const noexcept { return 0x1p6 * value; }
};

}  // namespace palpate
