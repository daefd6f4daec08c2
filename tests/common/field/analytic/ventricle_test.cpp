// The analytic ventricle: its coordinates, and its fibres against their closed form.
#include "common/field/analytic/ventricle.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(Ventricle, CoordinatesComeBack) {
  const Ventricle shape;
  for (const double lambda : {0.5, 0.63, 0.8})
    for (const double mu : {0.1, 1.0, 1.8})
      for (const double theta : {-3.0, 0.0, 2.2}) {
        const Prolate back = shape.coordinates(shape.position({lambda, mu, theta}));
        EXPECT_NEAR(back.lambda, lambda, 1e-12);
        EXPECT_NEAR(back.mu, mu, 1e-12);
        EXPECT_NEAR(back.theta, theta, 1e-12);
      }
}

TEST(Ventricle, WallAxesAreThoseOfItsCoordinates) {
  const Ventricle shape;
  const Prolate at{0.6, 0.9, 0.4};
  const Mat3 axes = shape.wall_axes(at);
  constexpr double kStep = 1e-6;
  const Vec3 x = shape.position(at);
  const auto towards = [&](const Prolate& to) { return glm::normalize(shape.position(to) - x); };
  EXPECT_LT(glm::distance(axes[0], towards({at.lambda, at.mu, at.theta + kStep})), 2e-6);
  EXPECT_LT(glm::distance(axes[1], towards({at.lambda, at.mu + kStep, at.theta})), 2e-6);
  EXPECT_LT(glm::distance(axes[2], towards({at.lambda + kStep, at.mu, at.theta})), 2e-6);
}

// Equation (3) against the fibre direction: the curve's tangent is the fibre.
TEST(Ventricle, FibresRunAlongTheirClosedForm) {
  const Ventricle shape;
  for (const double lambda : {0.52, 0.6, 0.72, 0.79}) {
    for (const double mu : {0.3, 0.9, 1.4, 1.8}) {
      const auto curve = [&](double m) {
        return shape.position({lambda, m, 0.3 + shape.turn(lambda, m) - shape.turn(lambda, mu)});
      };
      constexpr double kStep = 1e-5;
      const Vec3 tangent = glm::normalize(curve(mu + kStep) - curve(mu - kStep));
      const Vec3 fibre = shape.fibre({lambda, mu, 0.3});
      EXPECT_NEAR(std::abs(glm::dot(tangent, fibre)), 1.0, 1e-9) << lambda << " " << mu;
    }
  }
}

}  // namespace
}  // namespace palpate
