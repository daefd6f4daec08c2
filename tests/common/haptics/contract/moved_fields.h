/// Formula fields moved and scaled as a placement of the contract wants it.
#pragma once

#include <memory>
#include <utility>

#include "common/field/analytic/analytic_field.h"
#include "common/field/analytic/analytic_scalar.h"
#include "common/field/scalar_field.h"
#include "common/field/vector_field.h"
#include "tests/common/haptics/contract/constraint_contract.h"

namespace palpate::test {

/// How far moved formulas reach: bounds cannot be turned, so all placements have these.
inline const Box kMovedBounds{Vec3{-4.0}, Vec3{4.0}};

/// v(x) = R f(R^T (x - shift)).
class MovedVectors final : public AnalyticField {
 public:
  MovedVectors(std::shared_ptr<const AnalyticField> formula, const Placement& placement)
      : formula_(std::move(formula)), rotation_(placement.rotation), shift_(placement.shift) {}

  [[nodiscard]] Vec3 velocity(const Vec3& x) const noexcept override {
    return rotation_ * formula_->velocity((x - shift_) * rotation_);
  }
  [[nodiscard]] Mat3 jacobian(const Vec3& x) const noexcept override {
    return rotation_ * formula_->jacobian((x - shift_) * rotation_) * glm::transpose(rotation_);
  }
  [[nodiscard]] Box bounds() const noexcept override { return kMovedBounds; }
  [[nodiscard]] std::string name() const override { return formula_->name(); }
  [[nodiscard]] std::string description() const override { return formula_->description(); }

 private:
  std::shared_ptr<const AnalyticField> formula_;
  Mat3 rotation_;
  Vec3 shift_;
};

/// s(x) = f(R^T (x - shift)).
class MovedScalars final : public AnalyticScalar {
 public:
  MovedScalars(std::shared_ptr<const AnalyticScalar> formula, const Placement& placement)
      : formula_(std::move(formula)), rotation_(placement.rotation), shift_(placement.shift) {}

  [[nodiscard]] double value(const Vec3& x) const noexcept override {
    return formula_->value((x - shift_) * rotation_);
  }
  [[nodiscard]] Jet3 jet(const Vec3& x) const noexcept override {
    const Jet3 at = formula_->jet((x - shift_) * rotation_);
    return {at.value, rotation_ * at.gradient, rotation_ * at.hessian * glm::transpose(rotation_)};
  }
  [[nodiscard]] Box bounds() const noexcept override { return kMovedBounds; }
  [[nodiscard]] std::string name() const override { return formula_->name(); }
  [[nodiscard]] std::string description() const override { return formula_->description(); }

 private:
  std::shared_ptr<const AnalyticScalar> formula_;
  Mat3 rotation_;
  Vec3 shift_;
};

/// One data unit is 2^exponent local units; speeds are scaled alike, so that times stay.
[[nodiscard]] inline std::shared_ptr<const VectorField> moved_flow(
    std::shared_ptr<const AnalyticField> formula, const Placement& placement) {
  return make_vector_field(std::make_shared<const MovedVectors>(std::move(formula), placement),
                           placement.exponent, placement.exponent);
}

/// Values are scaled by 2^(2 exponent): another power than lengths, which no rule may notice.
[[nodiscard]] inline std::shared_ptr<const ScalarField> moved_scalars(
    std::shared_ptr<const AnalyticScalar> formula, const Placement& placement) {
  return make_scalar_field(std::make_shared<const MovedScalars>(std::move(formula), placement),
                           placement.exponent, 2 * placement.exponent);
}

}  // namespace palpate::test
