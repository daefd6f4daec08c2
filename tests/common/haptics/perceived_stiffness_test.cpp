// Perceived stiffness against differences of the size of a force, and what makes up for it.

#include "common/haptics/perceived_stiffness.h"

#include <cmath>

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace palpate
