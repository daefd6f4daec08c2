/// A flow whose lines are helices about the z axis, with all that there is to know of them in closed form.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "common/field/analytic/analytic_field.h"
#include "common/field/vector_field.h"

namespace palpate::test {

/// v = (-y, x, rise) on [-2, 2]^3: one radian a unit of time.
class HelixField final : public AnalyticField {
 public:
  explicit HelixField(double rise) : rise_(rise) {}
  [[nodiscard]] Vec3 velocity(const Vec3& x) const noexcept override { return {-x.y, x.x, rise_}; }
  [[nodiscard]] Mat3 jacobian(const Vec3&) const noexcept override {
    return Mat3{0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  }
  [[nodiscard]] Box bounds() const noexcept override { return {Vec3{-2.0}, Vec3{2.0}}; }
  [[nodiscard]] std::string name() const override { return "helix"; }
  [[nodiscard]] std::string description() const override { return "helices about z"; }

 private:
  double rise_;
};

/// The line through `seed`; time and arc are counted from there.
struct Helix {
  Vec3 seed{1.0, 0.0, 0.0};
  double rise = 0.0;

  [[nodiscard]] double radius() const { return std::hypot(seed.x, seed.y); }
  [[nodiscard]] double speed() const { return std::hypot(radius(), rise); }
  [[nodiscard]] Vec3 at_time(double t) const {
    const double c = std::cos(t), s = std::sin(t);
    return {c * seed.x - s * seed.y, s * seed.x + c * seed.y, seed.z + rise * t};
  }
  [[nodiscard]] Vec3 at_arc(double s) const { return at_time(s / speed()); }
};

[[nodiscard]] inline std::shared_ptr<const VectorField> helix_flow(double rise) {
  return make_vector_field(std::make_shared<const HelixField>(rise));
}

}  // namespace palpate::test
