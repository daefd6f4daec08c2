// The arm of the Falcon: golden positions, angles and torques of an independent evaluation; the loop closed
// by hand; rates against finite differences; and what is asked of it where it cannot be.

#include "common/kinematics/delta_arm.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kPerCount = (360.0 / 1280.0) * (14.25 / 110.0) * kDegree;
constexpr double kAtZero = 35.0 * kDegree;
constexpr Vec3 kSeed{0.0, 0.0, 0.11};

Vec3 angles_of(const Vec3& counts) { return Vec3{kAtZero} + kPerCount * counts; }

/// Positions all over the workspace, drawn in angles so that none lies outside of it.
std::vector<Vec3> positions(int count) {
  const DeltaArm arm{DeltaGeometry{}};
  std::mt19937 random{11};
  std::uniform_real_distribution<double> angle{-5.0 * kDegree, 75.0 * kDegree};
  std::vector<Vec3> found;
  while (static_cast<int>(found.size()) < count) {
    const DeltaForward at = arm.forward({angle(random), angle(random), angle(random)}, kSeed);
    if (at.converged) found.push_back(at.position);
  }
  return found;
}

TEST(DeltaArm, FindsTheGoldenPositions) {
  const DeltaArm arm{DeltaGeometry{}};
  const std::vector<std::pair<Vec3, Vec3>> golden{{{0, 0, 0}, {0, 0, 134.6024}},
                                                  {{500, 500, 500}, {0, 0, 156.8605}},
                                                  {{-500, -500, -500}, {0, 0, 110.7545}},
                                                  {{-1000, -1000, -1000}, {0, 0, 89.6106}},
                                                  {{100, -50, 25}, {4.0122, -3.8492, 135.6459}},
                                                  {{300, -200, 100}, {14.5276, -11.5785, 136.1478}},
                                                  {{-800, 200, 400}, {-4.0712, 41.4854, 122.6714}}};
  constexpr double kPrinted = 6e-5;  // [mm]
  for (const auto& [counts, millimetres] : golden) {
    const DeltaForward at = arm.forward(angles_of(counts), kSeed);
    ASSERT_TRUE(at.converged) << counts.x;
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(1e3 * at.position[a], millimetres[a], kPrinted);
  }
}

TEST(DeltaArm, HasTheGoldenAngles) {
  const DeltaArm arm{DeltaGeometry{}};
  const std::vector<std::pair<Vec3, Vec3>> golden{{{0, 0, 0.110}, {16.1880, 16.1880, 16.1880}},
                                                  {{0, 0, 0.125}, {27.7093, 27.7093, 27.7093}},
                                                  {{0, 0, 0.150}, {47.2433, 47.2433, 47.2433}},
                                                  {{0.03, 0, 0.125}, {37.1877, 12.5299, 43.4640}},
                                                  {{-0.03, 0.03, 0.140}, {24.3762, 64.3718, 48.9240}}};
  for (const auto& [position, degrees] : golden) {
    const auto pose = arm.at(position);
    ASSERT_TRUE(pose);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(pose->angles[a] / kDegree, degrees[a], 6e-5);
  }
}

TEST(DeltaArm, TurnsForcesIntoTheGoldenTorques) {
  const DeltaArm arm{DeltaGeometry{}};
  struct Row {
    Vec3 position, force, torques;
  };
  for (const auto& [position, force, torques] :
       {Row{{0, 0, .125}, {0, 0, 1}, {.025243, .025243, .025243}},
        Row{{0, 0, .125}, {1, 0, 0}, {.017890, -.060600, .042710}},
        Row{{0, 0, .125}, {0, 1, 0}, {-.059646, .014330, .045316}},
        Row{{.02, -.02, .11}, {1, -2, 3}, {.169478, .047447, .033252}}}) {
    const auto pose = arm.at(position);
    ASSERT_TRUE(pose);
    const Vec3 got = delta_torques(pose->rates, force);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(got[a], torques[a], 6e-7);
  }
}

// The joints of a leg as points: the shin's ends lie apart by its length whatever formula found the thigh.
TEST(DeltaArm, ClosesItsLoops) {
  const DeltaGeometry g;
  const DeltaArm arm{g};
  for (const Vec3& p : positions(500)) {
    const auto pose = arm.at(p);
    ASSERT_TRUE(pose);
    for (int i = 0; i < 3; ++i) {
      const double phi = g.leg_direction[static_cast<std::size_t>(i)];
      const double u = std::cos(phi) * p.x + std::sin(phi) * p.y - g.base_u;
      const double v = -std::sin(phi) * p.x + std::cos(phi) * p.y - g.base_v;
      const double reach = g.shin_ends + std::sqrt(g.shin * g.shin - (v + g.platform_v) * (v + g.platform_v));
      const double theta = pose->angles[i];
      const double open =
          std::hypot(u + g.platform_u - g.thigh * std::cos(theta), p.z - g.thigh * std::sin(theta));
      ASSERT_NEAR(open, reach, 1e-11);  // near its edges the root of (1) cancels digits
    }
  }
}

TEST(DeltaArm, RatesAreTheDerivativesOfTheAngles) {
  const DeltaArm arm{DeltaGeometry{}};
  constexpr double kStep = 1e-5;  // [m] truncation and rounding meet near 1e-9 of the rates
  for (const Vec3& p : positions(300)) {
    const auto pose = arm.at(p);
    ASSERT_TRUE(pose);
    for (int a = 0; a < 3; ++a) {
      // Of fourth order, so that the differences are good to the tolerance near the edges, too.
      Vec3 e{0.0};
      e[a] = kStep;
      const auto m2 = arm.at(p - 2.0 * e), m1 = arm.at(p - e), p1 = arm.at(p + e), p2 = arm.at(p + 2.0 * e);
      if (!m2 || !m1 || !p1 || !p2) continue;
      const Vec3 difference =
          (m2->angles - 8.0 * m1->angles + 8.0 * p1->angles - p2->angles) / (12.0 * kStep);
      const double scale = glm::length(pose->rates[a]) + 1.0;
      ASSERT_LT(glm::length(difference - pose->rates[a]), 1e-7 * scale);
    }
  }
}

TEST(DeltaArm, ForwardIsTheInverseOfInverseAndQuick) {
  const DeltaArm arm{DeltaGeometry{}};
  int most = 0;
  for (const Vec3& p : positions(1000)) {
    const auto pose = arm.at(p);
    ASSERT_TRUE(pose);
    const DeltaForward found = arm.forward(pose->angles, kSeed);
    ASSERT_TRUE(found.converged);
    ASSERT_LT(glm::distance(found.position, p), 1e-7);  // [m]
    const DeltaForward near = arm.forward(pose->angles, p + Vec3{1e-3, -1e-3, 1e-3});
    ASSERT_TRUE(near.converged);
    most = std::max(most, near.iterations);
  }
  EXPECT_LE(most, 5);
}

TEST(DeltaArm, IsSilentWhereItCannotBe) {
  const DeltaArm arm{DeltaGeometry{}};
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const Vec3& p : {Vec3{0, 0, 0.3}, Vec3{0.2, 0, 0.125}, Vec3{0, -1, 0}, Vec3{kNan, 0, 0.1},
                        Vec3{0, 0, HUGE_VAL}, Vec3{1e200, -1e200, 1e200}}) {
    EXPECT_FALSE(arm.at(p));
  }
  std::mt19937 random{3};
  std::uniform_real_distribution<double> any{-4.0, 4.0}, wide{-0.4, 0.4};
  for (int n = 0; n < 20000; ++n) {
    const DeltaForward at = arm.forward({any(random), any(random), any(random)}, kSeed);
    ASSERT_TRUE(is_finite(at.position));
    ASSERT_LE(at.iterations, DeltaArm::kMostIterations);
    ASSERT_TRUE(!at.converged || at.residual <= DeltaArm::kTolerance);
    if (const auto pose = arm.at({wide(random), wide(random), wide(random)})) {
      ASSERT_TRUE(is_finite(pose->angles));
      for (int a = 0; a < 3; ++a) ASSERT_TRUE(is_finite(pose->rates[a]));
      ASSERT_TRUE(is_finite(delta_torques(pose->rates, {1.0, 1.0, 1.0})));
    }
  }
  for (const Vec3& bad : {Vec3{kNan, 0, 0}, Vec3{HUGE_VAL}}) {
    const DeltaForward at = arm.forward(bad, kSeed);
    EXPECT_FALSE(at.converged);
    EXPECT_EQ(at.position, kSeed);
  }
}

TEST(DeltaArm, AllocatesNothing) {
  const DeltaArm arm{DeltaGeometry{}};
  const AllocationGuard guard;
  for (int n = 0; n < 1000; ++n) {
    const DeltaForward at = arm.forward(angles_of(Vec3{0.5 * n, 0.1 * n, -0.2 * n}), kSeed);
    (void)delta_torques(at.rates, {1.0, 2.0, 3.0});
  }
  EXPECT_EQ(guard.count(), 0U);
}

TEST(DeltaArm, RefusesGeometryThatIsNone) {
  DeltaGeometry g;
  EXPECT_TRUE(g.valid());
  g.thigh = 0.0;
  EXPECT_FALSE(g.valid());
  g = {};
  g.leg_direction[1] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(g.valid());
}

}  // namespace
}  // namespace palpate::test
