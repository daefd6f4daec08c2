/// Scalar formulas on [-4, 4]^3 whose derivatives can be read off.
#pragma once

#include <memory>
#include <string>

#include "common/field/analytic/analytic_scalar.h"
#include "common/field/scalar_field.h"

namespace palpate::test {

struct FormulaScalarBase {
  static constexpr Box kBounds{Vec3{-4.0}, Vec3{4.0}};
  static constexpr const char* kDescription = "for tests";
};

/// s = x.
struct Ramp : FormulaScalarBase {
  static constexpr const char* kName = "ramp";
  template <typename T>
  static T value(const T& x, const T& /*y*/, const T& /*z*/) {
    return x;
  }
};

/// s = 1.
struct Flat : FormulaScalarBase {
  static constexpr const char* kName = "flat";
  template <typename T>
  static T value(const T& x, const T& /*y*/, const T& /*z*/) {
    return 0.0 * x + 1.0;
  }
};

/// s = x^2 + y^2.
struct Cylinder : FormulaScalarBase {
  static constexpr const char* kName = "cylinder";
  template <typename T>
  static T value(const T& x, const T& y, const T& /*z*/) {
    return x * x + y * y;
  }
};

/// A quadratic with all of its terms.
struct Mixed : FormulaScalarBase {
  static constexpr const char* kName = "mixed";
  template <typename T>
  static T value(const T& x, const T& y, const T& z) {
    return x * x - 2.0 * y * y + 0.5 * z * z + x * y - 3.0 * y * z + 0.25 * z * x + x - y + 2.0;
  }
};

/// Data units are local units.
template <typename Formula>
[[nodiscard]] std::shared_ptr<const ScalarField> scalars() {
  return make_scalar_field(std::make_shared<const FormulaScalar<Formula>>());
}

}  // namespace palpate::test
