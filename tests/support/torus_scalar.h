/// A scalar field whose isosurfaces have a hole.
#pragma once

#include <cmath>
#include <memory>

#include "common/field/analytic/analytic_scalar.h"

namespace palpate::test {

struct Torus {
  static constexpr const char* kName = "torus";
  static constexpr const char* kDescription = "torus: squared distance from a circle of radius 1";
  static constexpr Box kBounds{{-1.5, -1.5, -0.75}, {1.5, 1.5, 0.75}};

  template <typename T>
  static T value(const T& x, const T& y, const T& z) noexcept {
    using std::sqrt;
    const T radius = sqrt(x * x + y * y + T(0x1p-100));  // its derivatives are finite on the axis, too
    const T away = radius - T(1.0);
    return away * away + z * z;
  }
};

/// The ring torus about the z axis of radius 1: squared distance from its core circle, over
/// [-1.5, 1.5] x [-1.5, 1.5] x [-0.75, 0.75]. It is not smooth on the axis.
inline std::shared_ptr<const AnalyticScalar> torus_scalar() {
  return std::make_shared<FormulaScalar<Torus>>();
}

}  // namespace palpate::test
