#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/field/analytic/volume_examples.h"
#include "common/field/scalar_field.h"
#include "tests/support/torus_scalar.h"

namespace palpate {
namespace {

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }

// Central differences have an error of h^2/6 times third derivatives, and of rounding over h.
TEST(ScalarExamples, JetsAreTheDerivatives) {
  std::mt19937_64 random(1);
  for (const auto& scalar : {sphere_scalar(), test::torus_scalar(), marschner_lobb_scalar()}) {
    const Box box = scalar->bounds();
    constexpr double kStep = 1e-5;
    for (int i = 0; i < 200; ++i) {
      const Vec3 x = box.lower + box.size() * Vec3{unit(random), unit(random), unit(random)};
      if (std::hypot(x.x, x.y) < 0.05) continue;  // the axis of the torus and of the rings
      const Jet3 at = scalar->jet(x);
      EXPECT_EQ(at.value, scalar->value(x));
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 ahead = x, behind = x;
        ahead[axis] += kStep;
        behind[axis] -= kStep;
        EXPECT_NEAR(at.gradient[axis], (scalar->value(ahead) - scalar->value(behind)) / (2.0 * kStep), 1e-5);
        const Vec3 slope = (scalar->jet(ahead).gradient - scalar->jet(behind).gradient) / (2.0 * kStep);
        EXPECT_LT(glm::distance(at.hessian[axis], slope), 1e-3) << scalar->name();
      }
    }
  }
}

TEST(ScalarExamples, HaveTheSurfacesThatTheyAreNamedAfter) {
  EXPECT_DOUBLE_EQ(sphere_scalar()->value({0.6, 0.0, 0.8}), 1.0);
  EXPECT_DOUBLE_EQ(test::torus_scalar()->value({0.6, 0.8, 0.25}), 0.0625);
  // Marschner and Lobb 1994, at the origin: (1 + alpha (1 + cos(2 pi f_M))) / (2 (1 + alpha)).
  EXPECT_NEAR(marschner_lobb_scalar()->value(Vec3{0.0}), 1.5 / 2.5, 1e-12);
}

TEST(ScalarExamples, MakeFieldsWhoseUnitsScaleByPowersOfTwo) {
  const auto field = make_scalar_field(sphere_scalar(), 4, -3);
  CellHint hint;
  EXPECT_EQ(field->sample({16.0, 0.0, 0.0}, hint).value, 0.125);
  EXPECT_EQ(field->gradient({16.0, 0.0, 0.0}, hint).value, Vec3(2.0 * 0.125 / 16.0, 0.0, 0.0));
  EXPECT_EQ(field->sample({25.0, 0.0, 0.0}, hint).status, SampleStatus::kOutside);
  EXPECT_EQ(field->highest(), 6.75 * 0.125);
  EXPECT_EQ(field->bounds().upper, Vec3(24.0));
}

}  // namespace
}  // namespace palpate
