// The balance of reactions on cases whose sums of forces can be done by hand.

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "lab/hand/chain/rivals.h"

namespace palpate {
namespace {

using Kind = HapticPrimitive::Kind;

constexpr double kStiffness = 200.0;

TEST(ForceBalance, HoldsUpToTheStrengthOfALine) {
  const std::array line{HapticPrimitive{Kind::kLine, Vec3{0.0}, {1.0, 0.0, 0.0}, 0.5}};
  // 2 mm aside are 0.4 N: held.
  EXPECT_LT(glm::distance(balanced_proxy({0.01, 0.002, 0.0}, kStiffness, line), {0.01, 0.0, 0.0}), 1e-12);
  // 5 mm aside are 1 N: it gives way until 0.5 N are left, 2.5 mm of stretch.
  EXPECT_LT(glm::distance(balanced_proxy({0.01, 0.003, 0.004}, kStiffness, line), {0.01, 0.0015, 0.002}),
            1e-12);
}

TEST(ForceBalance, HoldsOnOneSideOfAPlane) {
  const std::array plane{HapticPrimitive{Kind::kPlane, {0.0, 0.0, 0.1}, {0.0, 0.0, 1.0}, 0.5}};
  EXPECT_LT(glm::distance(balanced_proxy({1.0, 2.0, 0.2}, kStiffness, plane), {1.0, 2.0, 0.2}), 1e-12);
  EXPECT_LT(glm::distance(balanced_proxy({1.0, 2.0, 0.098}, kStiffness, plane), {1.0, 2.0, 0.1}), 1e-12);
  EXPECT_LT(glm::distance(balanced_proxy({1.0, 2.0, 0.09}, kStiffness, plane), {1.0, 2.0, 0.0925}), 1e-12);
}

// Along a line that goes into a plane at 30 degrees from its surface, pulled by q: the reaction of the plane
// is q / sin 30 = 2 q, and what of it is across the line, 2 q cos 30 = 1.73 q, the line has to take. The
// plane gives way at 2 q = s_plane, and the line, if it comes first, at 1.73 q = s_line: then the proxy
// leaves the curve along the surface.
TEST(ForceBalance, LeavesOneOrTheOtherWhereTheyCrossAtASmallAngle) {
  const double sine = 0.5, cosine = std::sqrt(0.75), strength = 0.5;
  const Vec3 t{cosine, 0.0, -sine};
  const auto both = [&](double plane_strength) {
    return std::array{HapticPrimitive{Kind::kLine, Vec3{0.0}, t, strength},
                      HapticPrimitive{Kind::kPlane, Vec3{0.0}, {0.0, 0.0, 1.0}, plane_strength}};
  };
  const double yields = strength / (2.0 * cosine) / kStiffness;  // m along the line
  EXPECT_LT(glm::length(balanced_proxy(0.99 * yields * t, kStiffness, both(2.0))), 1e-9);
  const Vec3 slid = balanced_proxy(1.1 * yields * t, kStiffness, both(2.0));
  EXPECT_NEAR(slid.z, 0.0, 1e-9) << "on the surface";
  EXPECT_GT(glm::length(slid - glm::dot(slid, t) * t), 1e-5) << "off the line";
  const Vec3 sunk = balanced_proxy(1.1 * yields * t, kStiffness, both(0.5));
  EXPECT_LT(glm::distance(sunk, glm::dot(sunk, t) * t), 1e-9) << "on the line";
  EXPECT_LT(sunk.z, -1e-5) << "behind the surface";
}

// The stated minimum, against places all around it.
TEST(ForceBalance, IsTheMinimumThatItStates) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  const auto any = [&] { return Vec3{normal(random), normal(random), normal(random)}; };
  for (int n = 0; n < 50; ++n) {
    std::array<HapticPrimitive, 3> primitives;
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      primitives[i] = {i == 0 ? Kind::kLine : Kind::kPlane, 0.002 * any(), glm::normalize(any()),
                       0.3 * std::abs(normal(random))};
    }
    const Vec3 probe = 0.004 * any();
    const auto cost = [&](const Vec3& p) {
      double sum = 0.5 * kStiffness * glm::dot(p - probe, p - probe);
      for (const HapticPrimitive& primitive : primitives) {
        const Vec3 away = p - primitive.through;
        const double along = glm::dot(away, primitive.direction);
        sum += primitive.strength * (primitive.kind == Kind::kLine
                                         ? glm::length(away - along * primitive.direction)
                                         : std::max(-along, 0.0));
      }
      return sum;
    };
    const Vec3 proxy = balanced_proxy(probe, kStiffness, primitives);
    for (int k = 0; k < 200; ++k) {
      EXPECT_GE(cost(proxy + 1e-4 * std::pow(0.5, k % 10) * any()), cost(proxy) - 1e-9);
    }
  }
}

}  // namespace
}  // namespace palpate
