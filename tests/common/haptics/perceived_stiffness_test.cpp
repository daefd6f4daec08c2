// Perceived stiffness against differences of the size of a force, and what makes up for it.

#include "common/haptics/perceived_stiffness.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/common/haptics/straight_links.h"

namespace palpate {
namespace {

constexpr double kStiffness = 300.0;  // [N/m]
constexpr double kMost = 1e9;

TEST(PerceivedStiffness, IsTheSlopeOfTheSizeOfTheForce) {
  for (const double across : {0.0, 0.2, 1.0, 3.0}) {
    for (const double stretch : {1e-4, 1e-3, 1e-2}) {
      constexpr double kAside = 1e-8;  // [m]
      const auto size = [&](double e) { return std::hypot(across, kStiffness * e); };
      const double slope = (size(stretch + kAside) - size(stretch - kAside)) / (2.0 * kAside);
      EXPECT_NEAR(perceived_stiffness(kStiffness, kStiffness * stretch, across), slope, 1e-4 * kStiffness);
    }
  }
  EXPECT_EQ(perceived_stiffness(kStiffness, 0.0, 0.0), kStiffness);
}

TEST(PerceivedStiffness, IsWhatItIsAloneWhereItIsCompensated) {
  for (const double across : {0.0, 0.2, 1.0, 3.0}) {
    for (const double stretch : {1e-4, 1e-3, 1e-2}) {
      const double more = kStiffness * stiffness_compensation(kStiffness * stretch, across, kMost);
      EXPECT_GE(more, kStiffness);
      EXPECT_NEAR(perceived_stiffness(more, more * stretch, across), kStiffness, 1e-9 * kStiffness);
    }
  }
}

TEST(PerceivedStiffness, IsMadeUpForNoFurtherThanADeviceBears) {
  EXPECT_EQ(stiffness_compensation(0.0, 1.0, 4.0), 4.0);
  EXPECT_EQ(stiffness_compensation(1e-9, 1.0, 4.0), 4.0);
  EXPECT_EQ(stiffness_compensation(1.0, 0.0, 4.0), 1.0);
}

/// Two springs across each other, by 3 and 1 mm.
ChainStep pulled_twice(double even_stiffness) {
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::make_unique<test::FlatPlane>(Vec3{1.0, 0.0, 0.0}));
  links.push_back(std::make_unique<test::FlatPlane>(Vec3{0.0, 1.0, 0.0}));
  ProxyChain chain(std::move(links), {.stiffness = kStiffness, .even_stiffness = even_stiffness});
  return chain.step({3e-3, 1e-3, 0.0});
}

TEST(PerceivedStiffness, IsSaidOfAChainAndMadeUpFor) {
  const ChainStep plain = pulled_twice(0.0);
  EXPECT_NEAR(plain.perceived_stiffness, kStiffness / std::sqrt(10.0), 1e-9 * kStiffness);
  EXPECT_EQ(plain.force, Vec3(-kStiffness * 3e-3, -kStiffness * 1e-3, 0.0));
  // Slopes of the size of the force are what both springs alone have.
  const Vec3 even = pulled_twice(1e9).force;
  for (const int axis : {0, 1}) {
    const double stretch = axis == 0 ? 3e-3 : 1e-3, spring = std::abs(even[axis]) / stretch;
    EXPECT_NEAR(spring * std::abs(even[axis]) / glm::length(even), kStiffness, 0.05 * kStiffness) << axis;
  }
  EXPECT_NEAR(pulled_twice(1e9).perceived_stiffness, kStiffness, 0.05 * kStiffness);
  // No spring is stiffer than was asked for.
  const Vec3 held = pulled_twice(1.2 * kStiffness).force;
  EXPECT_NEAR(held.y, -1.2 * kStiffness * 1e-3, 1e-12);
  EXPECT_LE(std::abs(held.x), 1.2 * kStiffness * 3e-3);
}

}  // namespace
}  // namespace palpate
