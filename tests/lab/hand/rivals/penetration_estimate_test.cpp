// Estimates of depth where they are right and where they are known to be wrong.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "lab/hand/constraint/surface_depth.h"

namespace palpate {
namespace {

TEST(DepthByValue, IsRightWhereTheSlopeIs) {
  EXPECT_DOUBLE_EQ(depth_by_value(7.0, 5.0, 4.0), 0.5);
  EXPECT_DOUBLE_EQ(depth_by_value(4.0, 5.0, 4.0), -0.25) << "outside";
  // s = 1 - r^2 at radius 1: the slope is 2 there, and at depth d the estimate is d - d^2 / 2.
  const double d = 0.2, r = 1.0 - d;
  EXPECT_NEAR(depth_by_value(1.0 - r * r, 0.0, 2.0), d - 0.5 * d * d, 1e-15);
}

TEST(DepthByPath, IsRightAroundASphere) {
  // Into the unit sphere and half around it at a depth of 0.1: normals are gradients, only steps err.
  DepthByPath path({1.0, 0.0, 0.0});
  constexpr int kSteps = 20000;
  for (int n = 1; n <= kSteps; ++n) {
    const double turn = std::numbers::pi * n / kSteps, r = 1.0 - 0.1 * std::min(1.0, 4.0 * n / kSteps);
    const Vec3 x{r * std::cos(turn), r * std::sin(turn), 0.0};
    path.move(x, -2.0 * x);
  }
  EXPECT_NEAR(path.depth(), 0.1, 3e-4);
  const double before = path.depth();
  path.move({0.0, 0.0, 0.0}, Vec3{0.0});
  EXPECT_EQ(path.depth(), before) << "no direction";
}

// Behind an ellipse the normals have a curl: each turn adds to the error, here out at one depth and back at
// another.
TEST(DepthByPath, DriftsOnALoopBehindAnEllipse) {
  const auto after_loops = [](int loops) {
    DepthByPath path({2.0, 0.0, 0.0});
    constexpr int kSteps = 20000;
    for (int loop = 0; loop < loops; ++loop) {
      for (int n = 1; n <= 2 * kSteps; ++n) {
        const bool out = n <= kSteps;
        const double part = static_cast<double>(out ? n : 2 * kSteps - n) / kSteps;
        const double turn = 0.5 * std::numbers::pi * part;
        // Out on the surface, back inside it, the same at both ends.
        const double scale = out ? 1.0 : 1.0 - 0.4 * std::sin(std::numbers::pi * part);
        const Vec3 x = scale * Vec3{2.0 * std::cos(turn), std::sin(turn), 0.0};
        path.move(x, {-0.5 * x.x, -2.0 * x.y, 0.0});
      }
    }
    return path.depth();
  };
  const double once = after_loops(1), thrice = after_loops(3);
  EXPECT_GT(std::abs(once), 0.01) << "the probe is back on the surface";
  EXPECT_NEAR(thrice, 3.0 * once, 1e-9);
}

}  // namespace
}  // namespace palpate
