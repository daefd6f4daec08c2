/// Vector fields given by a formula, with exact derivatives: built-in examples and ground truth.
///
/// Formulas live in dimensionless local units (frame L); a VectorField made from one may scale lengths and
/// speeds by powers of two (vector_field.h).
#pragma once

#include <string>

#include "common/math/vec.h"

namespace palpate {

/// Immutable; evaluation is thread safe.
class AnalyticField {
 public:
  AnalyticField() = default;
  AnalyticField(const AnalyticField&) = delete;
  AnalyticField& operator=(const AnalyticField&) = delete;
  virtual ~AnalyticField() = default;

  /// v(x). Defined, if not meaningful, outside bounds() too. @rt Safe.
  [[nodiscard]] virtual Vec3 velocity(const Vec3& x) const noexcept = 0;
  /// dv_i/dx_j at m[j][i]. @rt Safe.
  [[nodiscard]] virtual Mat3 jacobian(const Vec3& x) const noexcept = 0;
  /// Where the field is shown and traced.
  [[nodiscard]] virtual Box bounds() const noexcept = 0;
  [[nodiscard]] virtual std::string name() const = 0;
  /// One line: what it is, its source, and what it is not.
  [[nodiscard]] virtual std::string description() const = 0;
};

}  // namespace palpate
