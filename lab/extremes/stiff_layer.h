/// A flow that is drawn onto a slow surface at any rate, whose lines are known in closed form.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "common/field/analytic/analytic_field.h"

namespace palpate {

/// Drawn onto z = g(x, y) = a x + b y + c x y at the rate Lambda: of degree one in each coordinate, so that
/// trilinear data is the formula, and with c = 0 linear data on tetrahedra too. The lines:
///
///   x = x0 + t,  y = y0 + t / 4,  z - g = (z0 - g0) exp(-Lambda t)
class StiffLayer final : public AnalyticField {
 public:
  StiffLayer(double rate, double c) : rate_(rate), c_(c) {}
  [[nodiscard]] Vec3 velocity(const Vec3& x) const noexcept override {
    return {1.0, kAside, kA + c_ * x.y + kAside * (kB + c_ * x.x) - rate_ * (x.z - height(x))};
  }
  [[nodiscard]] Mat3 jacobian(const Vec3& x) const noexcept override {
    return {Vec3{0.0, 0.0, kAside * c_ + rate_ * (kA + c_ * x.y)},
            Vec3{0.0, 0.0, c_ + rate_ * (kB + c_ * x.x)}, Vec3{0.0, 0.0, -rate_}};
  }
  [[nodiscard]] Box bounds() const noexcept override { return {{0.0, 0.0, -0.5}, {2.0, 1.0, 0.5}}; }
  [[nodiscard]] std::string name() const override { return "layer"; }
  [[nodiscard]] std::string description() const override { return "layer"; }

  [[nodiscard]] Vec3 line(const Vec3& seed, double t) const {
    Vec3 x{seed.x + t, seed.y + kAside * t, 0.0};
    x.z = height(x) + (seed.z - height(seed)) * std::exp(-rate_ * t);
    return x;
  }
  /// Distance of `x` from the line, to leading order: where it has the same x, or the same height above g.
  [[nodiscard]] double distance(const Vec3& seed, const Vec3& x) const {
    const double part = (x.z - height(x)) / (seed.z - height(seed));
    double nearest = glm::distance(x, line(seed, x.x - seed.x));
    if (part > 0.0)
      nearest = std::min(nearest, glm::distance(x, line(seed, std::max(0.0, -std::log(part) / rate_))));
    return nearest;
  }

 private:
  [[nodiscard]] double height(const Vec3& x) const { return kA * x.x + kB * x.y + c_ * x.x * x.y; }
  static constexpr double kA = 0.1, kB = -0.05, kAside = 0.25;
  double rate_, c_;
};

}  // namespace palpate
