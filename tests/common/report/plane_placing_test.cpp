// A hand of tremor and delay places planes: reproducibly, and with constraints that keep what they constrain.

#include "common/report/plane_placing.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palpate {
namespace {

PlacingTrial trial(PlacingMeans means, double tremor, int number = 0) {
  return place_plane(means, {.tremor = tremor}, number);
}

TEST(PlanePlacing, EqualSeedsGiveEqualBits) {
  for (int m = 0; m < kPlacingMeansCount; ++m) {
    const auto means = static_cast<PlacingMeans>(m);
    const PlacingTrial a = trial(means, 3e-4), b = trial(means, 3e-4), other = trial(means, 3e-4, 1);
    EXPECT_EQ(a.seconds, b.seconds) << name_of(means);
    EXPECT_EQ(a.off, b.off);
    EXPECT_EQ(a.sideways, b.sideways);
    EXPECT_TRUE(a.seconds != other.seconds || a.off != other.off) << name_of(means);
  }
}

// Without tremor every means gets there, in no less than the model of the operator takes: a loop that crosses
// over at 2.5 rad/s needs 1.5 time constants to come within a twentieth.
TEST(PlanePlacing, AStillHandGetsThereByEveryMeans) {
  for (int m = 0; m < kPlacingMeansCount; ++m) {
    const PlacingTrial still = trial(static_cast<PlacingMeans>(m), 0.0);
    EXPECT_TRUE(still.placed) << name_of(static_cast<PlacingMeans>(m));
    EXPECT_GT(still.seconds, 0.6);
    EXPECT_LE(still.off, 0.0006);
  }
}

TEST(PlanePlacing, ConstraintsKeepTheOtherAxes) {
  for (int n = 0; n < 3; ++n) {
    for (const PlacingMeans means : {PlacingMeans::kGrid, PlacingMeans::kGridTeeth,
                                     PlacingMeans::kGridLandmark, PlacingMeans::kWidgetConstrained}) {
      const PlacingTrial held = trial(means, 3e-4, n);
      EXPECT_EQ(held.sideways, 0.0) << name_of(means) << ": to the bit";
    }
    const PlacingTrial free = trial(PlacingMeans::kHandAlone, 3e-4, n);
    if (free.placed) {
      EXPECT_GT(free.sideways, 0.0);
    }
  }
  const PlacingTrial landmark = trial(PlacingMeans::kGridLandmark, 3e-4);
  ASSERT_TRUE(landmark.placed);
  EXPECT_EQ(landmark.off, 0.0) << "the very place of the landmark";
}

}  // namespace
}  // namespace palpate
