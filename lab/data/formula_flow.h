/// A flow whose lines are known in closed form, for measuring constraints that follow them.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "common/field/analytic/analytic_field.h"
#include "common/field/vector_field.h"

namespace palpate {

class FormulaFlow final : public AnalyticField {
 public:
  using Velocity = std::function<Vec3(const Vec3&)>;
  using Jacobian = std::function<Mat3(const Vec3&)>;

  FormulaFlow(Velocity velocity, Jacobian jacobian, const Box& bounds)
      : velocity_(std::move(velocity)), jacobian_(std::move(jacobian)), bounds_(bounds) {}
  [[nodiscard]] Vec3 velocity(const Vec3& x) const noexcept override { return velocity_(x); }
  [[nodiscard]] Mat3 jacobian(const Vec3& x) const noexcept override { return jacobian_(x); }
  [[nodiscard]] Box bounds() const noexcept override { return bounds_; }
  [[nodiscard]] std::string name() const override { return "flow"; }
  [[nodiscard]] std::string description() const override { return "made for a report"; }

 private:
  Velocity velocity_;
  Jacobian jacobian_;
  Box bounds_;
};

/// v = (-y, x, rise) on [-2, 2]^3: helices about the z axis, circles where they do not rise.
[[nodiscard]] inline std::shared_ptr<const VectorField> turning_flow(double rise) {
  return make_vector_field(std::make_shared<const FormulaFlow>(
      [rise](const Vec3& x) {
        return Vec3{-x.y, x.x, rise};
      },
      [](const Vec3&) { return Mat3{0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0}; },
      Box{Vec3{-2.0}, Vec3{2.0}}));
}

/// v = (1, rate y, 0) for x from -0.5 to 1.5: the lines y = y0 exp(rate x) part from each other, the
/// divergence is `rate`.
[[nodiscard]] inline std::shared_ptr<const VectorField> parting_flow(double rate) {
  return make_vector_field(std::make_shared<const FormulaFlow>(
      [rate](const Vec3& x) {
        return Vec3{1.0, rate * x.y, 0.0};
      },
      [rate](const Vec3&) { return Mat3{0.0, 0.0, 0.0, 0.0, rate, 0.0, 0.0, 0.0, 0.0}; },
      Box{Vec3{-0.5, -1.0, -0.5}, Vec3{1.5, 1.0, 0.5}}));
}

}  // namespace palpate
