// Tick marks on a rotation, where equal times are equal angles.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "common/haptics/constraint/detent_marks.h"
#include "tests/common/haptics/followed_flow.h"

namespace palpate {
namespace {

using test::FollowedFlow;
using test::rows;

constexpr double kRate = 2.0;  // radians a unit of time
constexpr double kTick = 0.05;

FollowedFlow turning() {
  return FollowedFlow(test::on_tetrahedra(rows(0, -2, 0, 2, 0, 0, 0, 0, 0), Vec3{0.0}, 9, 0.2, 1), 0.1,
                      kTick);
}

double angle_of(const Vec3& x) { return std::atan2(x.y, x.x); }

TEST(TickMarks, LieAtEqualTimesAndArePassedOneByOne) {
  FollowedFlow flow = turning();
  int jumps = 0;
  double mark = 0.0;
  for (int n = 0; n < 990; ++n) {
    const double angle = n * 1e-3;  // marks are 0.1 radians apart
    const ChainStep step = flow.chain->step({0.5 * std::cos(angle), 0.5 * std::sin(angle), 0.0});
    ASSERT_EQ(step.links, 2);
    const double at = angle_of(step.proxies[1]) / (kRate * kTick);
    EXPECT_NEAR(at, std::round(at), 1e-6) << "on a mark";
    EXPECT_LE(std::abs(angle / (kRate * kTick) - at), 1.0 + 1e-6) << "within one interval";
    if (std::abs(at - mark) > 0.5) ++jumps;
    mark = at;
    EXPECT_NEAR(glm::length(step.proxies[1]), 0.5, 1e-6) << "on the line";
  }
  EXPECT_EQ(jumps, 9) << "one at each of 0.1, 0.2, … 0.9";
}

TEST(TickMarks, HaveHysteresis) {
  FollowedFlow flow = turning();
  const auto mark_at = [&](double angle) {
    const ChainStep step = flow.chain->step({0.5 * std::cos(angle), 0.5 * std::sin(angle), 0.0});
    return std::lround(angle_of(step.proxies[1]) / (kRate * kTick));
  };
  EXPECT_EQ(mark_at(0.0), 0);
  EXPECT_EQ(mark_at(0.099), 0);
  EXPECT_EQ(mark_at(0.101), 1);
  EXPECT_EQ(mark_at(0.099), 1) << "back by a little: no chatter";
  EXPECT_EQ(mark_at(0.001), 1);
  EXPECT_EQ(mark_at(-0.001), 0);
}

TEST(TickMarks, PullTowardsTheMark) {
  FollowedFlow flow = turning();
  (void)flow.chain->step({0.5, 0.0, 0.0});
  const ChainStep step = flow.chain->step({0.5 * std::cos(0.08), 0.5 * std::sin(0.08), 0.0});
  const double chord = 2.0 * 0.5 * std::sin(0.04);
  // Only along the line does the streamline pass the pull on to the hand (chain_force.h): the chord's part
  // along the tangent.
  EXPECT_NEAR(glm::length(step.force), 200.0 * 0.25 * chord * std::cos(0.04), 1e-5);
  EXPECT_LT(step.force.y, 0.0);
}

}  // namespace
}  // namespace palpate
