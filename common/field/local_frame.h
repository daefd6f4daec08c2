/// Local frame L of a field: the data frame X turned to the grid's axes and divided by powers of two, so
/// that lengths and speeds are near one and every later step sees dimensionless numbers.
///
///   x_X = 2^length_exponent  R x_L          v_X = 2^speed_exponent  R v_L
///   t_X = 2^(length_exponent - speed_exponent) t_L
///
/// R is a rotation; of a field of scalars, which no hand of the axes changes, it may mirror (FallingAxes).
/// With R = 1 (all but rotated images) every conversion is exact: a data set scaled by 2^k gives the
/// same bits in L. Nothing is translated, since a translation would round.
#pragma once

#include "common/math/power_of_two.h"
#include "common/math/vec.h"

namespace palpate {

struct LocalFrame {
  int length_exponent = 0;
  int speed_exponent = 0;
  Mat3 rotation{1.0};    ///< R, orthonormal, data_from_local
  bool rotated = false;  ///< R is not the identity

  [[nodiscard]] double length_scale() const noexcept { return power_of_two(length_exponent); }
  [[nodiscard]] double speed_scale() const noexcept { return power_of_two(speed_exponent); }
  [[nodiscard]] double time_scale() const noexcept { return power_of_two(length_exponent - speed_exponent); }

  [[nodiscard]] Vec3 local_from_data(const Vec3& x) const noexcept {
    const Vec3 scaled = x * power_of_two(-length_exponent);
    return rotated ? scaled * rotation : scaled;  // row vector times R is R^T times column
  }
  [[nodiscard]] Vec3 data_from_local(const Vec3& x) const noexcept {
    return (rotated ? rotation * x : x) * length_scale();
  }
  [[nodiscard]] Vec3 data_from_local_velocity(const Vec3& v) const noexcept {
    return (rotated ? rotation * v : v) * speed_scale();
  }
};

}  // namespace palpate
