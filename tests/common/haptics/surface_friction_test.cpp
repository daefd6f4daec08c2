// Friction against Coulomb's law: on a wall, whose depth and normal are known.

#include "common/haptics/constraint/surface_friction.h"

#include <cmath>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "common/haptics/constraint/half_space.h"
#include "common/haptics/proxy_chain.h"

namespace palpate {
namespace {

constexpr double kStiffness = 500.0;

/// A wall z < 0 that rubs.
ProxyChain rough_wall(const ContactSettings& contact) {
  auto wall = std::make_unique<HalfSpaceConstraint>(Vec3{0.0}, Vec3{0.0, 0.0, 1.0});
  auto friction = std::make_unique<SurfaceFriction>(*wall);
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::move(wall));
  links.push_back(std::move(friction));
  ChainSettings settings{.stiffness = kStiffness};
  settings.contact = contact;
  return {std::move(links), settings};
}

TEST(SurfaceFriction, SticksAndSlidesByCoulombsLaw) {
  ProxyChain wall = rough_wall({.sticking = 0.8, .sliding = 0.3});
  constexpr double kDepth = 0.004;
  (void)wall.step({0.0, 0.0, 0.001});
  (void)wall.step({0.0, 0.0, -kDepth});
  const double push = kStiffness * kDepth;
  bool slid = false;
  for (int n = 1; n <= 200; ++n) {
    const double x = 1e-4 * n;
    const Vec3 force = wall.step({x, 0.0, -kDepth}).force;
    ASSERT_NEAR(force.z, push, 1e-12) << "friction does not lift";
    ASSERT_EQ(force.y, 0.0);
    if (!slid && kStiffness * x <= 0.8 * push + 1e-9) {
      ASSERT_NEAR(force.x, -kStiffness * x, 1e-9) << "it sticks";
    } else {
      slid = true;
      ASSERT_NEAR(force.x, -0.3 * push, 1e-9) << "it slides";
    }
  }
  ASSERT_TRUE(slid);
  // Pressed harder it is dragged harder; turned around it sticks first.
  EXPECT_NEAR(wall.step({0.0201, 0.0, -kDepth}).force.x, -0.3 * push, 1e-9);
  const double back = wall.step({0.0196, 0.0, -kDepth}).force.x;
  EXPECT_NEAR(back, -0.3 * push + kStiffness * 0.0005, 1e-9);
}

TEST(SurfaceFriction, OffTheSurfaceThereIsNone) {
  ProxyChain wall = rough_wall({.sticking = 0.8, .sliding = 0.3});
  (void)wall.step({0.0, 0.0, -0.002});
  (void)wall.step({0.01, 0.0, -0.002});
  EXPECT_EQ(wall.step({0.011, 0.0, 0.0005}).force, Vec3{0.0});
  EXPECT_EQ(wall.step({0.02, 0.0, -0.001}).force.x, 0.0) << "where it is met again it begins anew";
}

TEST(SurfaceFriction, AGrainSticksAndSlipsByItsSize) {
  constexpr double kGrain = 0.0015;
  ProxyChain wall = rough_wall({.grain = kGrain});
  (void)wall.step({0.0, 0.0, -0.002});
  int slips = 0;
  double before = 0.0, most = 0.0;
  for (int n = 1; n <= 3000; ++n) {
    const double force = wall.step({1e-5 * n, 0.0, -0.002}).force.x;
    slips += before < -1e-9 && force == 0.0 ? 1 : 0;
    most = std::max(most, -force);
    before = force;
  }
  EXPECT_NEAR(most, kStiffness * kGrain, 1e-2 * kStiffness * kGrain);
  EXPECT_NEAR(slips, 30e-3 / kGrain, 1.0);
}

// Whatever way a hand goes on it, it gets no energy back.
TEST(SurfaceFriction, OnlyTakesEnergy) {
  for (const ContactSettings contact : {ContactSettings{.sticking = 0.8, .sliding = 0.3},
                                        ContactSettings{.sticking = 0.4, .sliding = 0.4, .grain = 0.001}}) {
    ProxyChain wall = rough_wall(contact);
    double work = 0.0;
    Vec3 before{0.0, 0.0, 0.001}, force{0.0};
    for (int n = 0; n <= 200'000; ++n) {
      const double t = 1e-4 * n;
      const Vec3 x{0.01 * std::sin(3.0 * t), 0.008 * std::cos(5.0 * t), -0.002 + 0.003 * std::cos(2.0 * t)};
      const Vec3 now = wall.step(x).force;
      if (n > 0) work += glm::dot(0.5 * (now + force), x - before);
      before = x;
      force = now;
    }
    const double held = 0.5 * kStiffness * 0.005 * 0.005 * 4.0;
    EXPECT_LT(work, held) << "[J] given to the hand; what springs hold at the end is all that may be";
    EXPECT_LT(work, -0.001) << "and it has taken some";
  }
}

}  // namespace
}  // namespace palpate
