/// Scalar fields given by a formula, with exact first and second derivatives: built-in volumes and ground
/// truth.
///
/// Formulas live in dimensionless local units (frame L); a ScalarField made from one may scale lengths and
/// values by powers of two (scalar_field.h).
#pragma once

#include <string>

#include "common/math/jet.h"
#include "common/math/vec.h"

namespace palpate {

/// Immutable; evaluation is thread safe.
class AnalyticScalar {
 public:
  AnalyticScalar() = default;
  AnalyticScalar(const AnalyticScalar&) = delete;
  AnalyticScalar& operator=(const AnalyticScalar&) = delete;
  virtual ~AnalyticScalar() = default;

  /// s(x). Defined, if not meaningful, outside bounds() too. @rt Safe.
  [[nodiscard]] virtual double value(const Vec3& x) const noexcept = 0;
  /// s, its gradient and its Hessian at x. @rt Safe.
  [[nodiscard]] virtual Jet3 jet(const Vec3& x) const noexcept = 0;
  /// Where the field is shown and felt.
  [[nodiscard]] virtual Box bounds() const noexcept = 0;
  [[nodiscard]] virtual std::string name() const = 0;
  /// One line: what it is and its source.
  [[nodiscard]] virtual std::string description() const = 0;
};

/// A field whose formula is written once over any number type, as
/// `template <typename T> static T value(const T& x, const T& y, const T& z)` beside kName, kDescription and
/// kBounds: derivatives come from jets.
template <typename Formula>
class FormulaScalar final : public AnalyticScalar {
 public:
  [[nodiscard]] double value(const Vec3& x) const noexcept override { return Formula::value(x.x, x.y, x.z); }
  [[nodiscard]] Jet3 jet(const Vec3& x) const noexcept override {
    return Formula::value(Jet3::variable(x, 0), Jet3::variable(x, 1), Jet3::variable(x, 2));
  }
  [[nodiscard]] Box bounds() const noexcept override { return Formula::kBounds; }
  [[nodiscard]] std::string name() const override { return Formula::kName; }
  [[nodiscard]] std::string description() const override { return Formula::kDescription; }
};

}  // namespace palpate
