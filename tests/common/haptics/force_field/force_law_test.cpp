#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/haptics/force_field/force_field.h"

namespace palpate::test {
namespace {

constexpr double kRounding = 1e-14;

void expect_near(const Vec3& a, const Vec3& b, double tolerance = kRounding) {
  EXPECT_LE(glm::distance(a, b), tolerance)
      << a.x << ' ' << a.y << ' ' << a.z << " and " << b.x << ' ' << b.y << ' ' << b.z;
}

Vec3 force_of(const AxisDrag& drag, const Vec3& velocity) {
  return -(drag.frame * (drag.damping * (velocity * drag.frame)));
}

TEST(ForceLaw, DirectForceIsTheVelocityOverTheLargestSpeed) {
  const FlowScale scale{.speed = 6.0};
  EXPECT_EQ(direct_force({1, -2, 2}, scale, 3.0), Vec3(0.5, -1.0, 1.0));
  EXPECT_EQ(direct_force({1, -2, 2}, scale, -3.0), Vec3(-0.5, 1.0, -1.0)) << "against the flow";
  EXPECT_EQ(direct_force(Vec3{0.0}, scale, 3.0), Vec3(0.0));
  EXPECT_EQ(direct_force({1, 0, 0}, {}, 3.0), Vec3(0.0)) << "a flow at rest has no scale";
}

TEST(ForceLaw, VortexForcePointsToTheAxisOfAHelix) {
  // v = 2 (-y, x, 0) + (0, 0, 5) has omega = (0, 0, 4): at (0.1, 0, z) omega x v = 4 * 0.2 (-1, 0, 0).
  const Vec3 v{0.0, 0.2, 5.0}, omega{0.0, 0.0, 4.0};
  const FlowScale scale{.speed = 10.0, .vorticity = 2.0, .lamb = 0.08};
  expect_near(lamb_vector(omega, v, scale), {-0.04, 0.0, 0.0});
  expect_near(vortex_force(omega, v, scale, 3.0), {-1.5, 0.0, 0.0});
  expect_near(vortex_force(omega, 10.0 * v, scale, 3.0), {-3.0, 0.0, 0.0});  // no more than the strength
  EXPECT_EQ(vortex_force(omega, v, {.speed = 10.0, .vorticity = 2.0}, 3.0), Vec3(0.0)) << "no vortices";
  EXPECT_EQ(vortex_force(omega, 0.5 * omega, scale, 3.0), Vec3(0.0)) << "on the axis of a jet";
}

TEST(ForceLaw, TransverseDragOpposesMotionAcrossTheFlowOnly) {
  const FlowScale scale{.speed = 10.0};
  // |v| / v_max = 0.3, of a fade up to 0.5: u = 0.6, g = 0.36 * 1.8 = 0.648.
  expect_near(force_of(transverse_drag({0, 0, 3}, scale, 5.0, 0.5), {1, 2, 3}), {-3.24, -6.48, 0.0});
  expect_near(force_of(transverse_drag({0, 0, -3}, scale, 5.0, 0.5), {1, 2, 3}), {-3.24, -6.48, 0.0});
  // Fast flow along (1, 1, 0): the part (1, -1, 0) / 2 of a hand that moves along x is across.
  expect_near(force_of(transverse_drag({7, 7, 0}, scale, 4.0, 0.05), {1, 0, 0}), {-2.0, 2.0, 0.0});
  expect_near(force_of(transverse_drag({7, 7, 0}, scale, 4.0, 0.05), {3, 3, 0}), Vec3{0.0});
}

TEST(ForceLaw, TransverseDragNeverPushesTheHandOnAndFadesWhereTheFlowRests) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const auto any = [&] { return Vec3{normal(random), normal(random), normal(random)}; };
  const FlowScale scale{.speed = 1.0};
  constexpr double kDamping = 5.0, kFade = 0.1;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 v = any() * std::exp2(static_cast<double>(random() % 60) - 50.0), velocity = any();
    const Vec3 force = force_of(transverse_drag(v, scale, kDamping, kFade), velocity);
    ASSERT_LE(glm::dot(force, velocity), kRounding);
    ASSERT_LE(glm::length(force), kDamping * glm::length(velocity) * (1.0 + kRounding));
  }
  // A flow that turns round through a point where it rests: what is felt changes no faster than g does, by a
  // slope of 3/2 over the fade.
  Vec3 before{0.0};
  constexpr double kStep = 1e-4;
  for (int i = -3000; i <= 3000; ++i) {
    const Vec3 v = kStep * i * glm::normalize(Vec3{1.0, i > 0 ? 1.0 : -0.5, 0.2});
    const Vec3 force = force_of(transverse_drag(v, scale, kDamping, kFade), {0, 1, 0});
    if (i > -3000) {
      ASSERT_LE(glm::distance(force, before), 1.001 * kDamping * 1.5 * kStep / kFade) << i;
    }
    before = force;
  }
  EXPECT_EQ(force_of(transverse_drag(Vec3{0.0}, scale, kDamping, kFade), {0, 1, 0}), Vec3(0.0));
  EXPECT_EQ(force_of(transverse_drag({1, 0, 0}, {}, kDamping, kFade), {0, 1, 0}), Vec3(0.0));
}

TEST(ForceLaw, DensityRisesFromTheLowestValueToTheHighest) {
  EXPECT_EQ(density_part(-1.0, -1.0, 3.0), 0.0);
  EXPECT_EQ(density_part(0.0, -1.0, 3.0), 0.25);
  EXPECT_EQ(density_part(3.0, -1.0, 3.0), 1.0);
  EXPECT_EQ(density_part(7.0, -1.0, 3.0), 1.0);
  EXPECT_EQ(density_part(-7.0, -1.0, 3.0), 0.0);
  EXPECT_EQ(density_part(2.0, 2.0, 2.0), 0.0) << "nothing tells high from low";
  EXPECT_EQ(density_part(2.0, 0.0, -1.0), 0.0) << "no values";
}

}  // namespace
}  // namespace palpate::test
