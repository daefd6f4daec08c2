// Magnets and gravity wells: their profiles, and that they give no energy.

#include "common/haptics/constraint/landmark_pull.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

namespace palpate {
namespace {

Vec3 pull_at(Constraint& landmarks, const Vec3& probe) {
  LinkUpdate link;
  landmarks.update(probe, {}, link);
  EXPECT_EQ(link.proxy, probe);
  return link.extra_force;
}

TEST(LandmarkPull, HasItsProfile) {
  const Vec3 m{0.1, 0.2, 0.3};
  for (const auto kind : {Landmark::Pull::kMagnet, Landmark::Pull::kWell}) {
    LandmarkPull one({{.at = m, .pull = kind, .reach = 0.02, .force = 1.5}});
    double most = 0.0;
    for (int n = 0; n <= 2000; ++n) {
      const double u = 1e-3 * n;
      const Vec3 f = pull_at(one, m - Vec3{0.02 * u, 0.0, 0.0});
      most = std::max(most, f.x);
      const double rest = std::max(0.0, 1.0 - u * u);
      const double expected = kind == Landmark::Pull::kMagnet ? 25.0 * std::sqrt(5.0) / 16.0 * u * rest * rest
                                                              : 1.5 * std::sqrt(3.0) * u * rest;
      ASSERT_NEAR(f.x, 1.5 * expected, 1e-12) << u;
    }
    EXPECT_NEAR(most, 1.5, 1e-5);
  }
}

TEST(LandmarkPull, GivesNothingOnAClosedWay) {
  LandmarkPull some({{.at = Vec3{0.0}, .pull = Landmark::Pull::kMagnet, .reach = 0.01, .force = 2.0},
                     {.at = {0.02, 0.0, 0.0}, .pull = Landmark::Pull::kWell, .reach = 0.06, .force = -0.7}});
  double work = 0.0, taken = 0.0;
  constexpr int kParts = 40'000;
  const auto way = [](double s) {
    const double a = 2.0 * std::numbers::pi * s;
    return Vec3{0.01 * std::cos(a), 0.012 * std::sin(a), 0.004 * std::sin(2.0 * a)};
  };
  for (int n = 0; n < kParts; ++n) {
    const Vec3 a = way(1.0 * n / kParts), b = way((n + 1.0) / kParts);
    const double part = glm::dot(pull_at(some, 0.5 * (a + b)), b - a);
    work += part;
    taken += std::abs(part);
  }
  EXPECT_GT(taken, 1e-3);
  EXPECT_LT(std::abs(work), 1e-9);
}

TEST(LandmarkPull, TakesNoMoreThanItSays) {
  EXPECT_THROW(LandmarkPull(std::vector<Landmark>(LandmarkPull::kMost + 1)), std::length_error);
}

}  // namespace
}  // namespace palpate
