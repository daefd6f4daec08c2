#include "common/field/tensor/eigenframe.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace palpate {
namespace {

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }

/// Frenet-like frame of a helix: turns all the way round, several times.
Mat3 frame_at(double t) {
  const Vec3 e1 = glm::normalize(Vec3{-std::sin(t), std::cos(t), 0.4});
  const Vec3 e2{-std::cos(t), -std::sin(t), 0.0};
  return {e1, e2, glm::cross(e1, e2)};
}

TEST(CarriedFrame, FollowsAPathWithoutFlipsWhateverTheSignsThatTheSolverChose) {
  std::mt19937_64 random(1);
  Mat3 carried = frame_at(0.0);
  for (int i = 1; i <= 2000; ++i) {
    const Mat3 truth = frame_at(0.01 * i);
    Mat3 found = truth;
    if (random() % 2 == 0) found[0] = -found[0];
    if (random() % 2 == 0) found[1] = -found[1];
    found[2] = glm::cross(found[0], found[1]);
    carried = carried_frame(found, carried);
    for (int axis = 0; axis < 3; ++axis) EXPECT_LT(glm::distance(carried[axis], truth[axis]), 1e-15);
  }
}

TEST(EigenGaps, SayWhereAxesCanBeTurnedFreely) {
  EXPECT_EQ(eigen_gaps({2.0, 2.0, 1.0}).major, 0.0);
  EXPECT_EQ(eigen_gaps({2.0, 2.0, 1.0}).minor, 0.5);
  EXPECT_EQ(eigen_gaps({2.0, 1.0, 1.0}).major, 0.5);
  EXPECT_EQ(eigen_gaps({2.0, 1.0, 1.0}).minor, 0.0);
  EXPECT_EQ(eigen_gaps({2.0, -1.0, -5.0}).major, 1.0);
  EXPECT_EQ(eigen_gaps({2.0, -1.0, -5.0}).minor, 0.0);
  EXPECT_EQ(eigen_gaps({-1.0, -1.0, -5.0}).major, 0.0);
}

TEST(DirectionMean, SignsAndLengthsDoNotMatter) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 100; ++round) {
    DirectionMean mean, flipped;
    for (int i = 0; i < 8; ++i) {
      const Vec3 d = glm::normalize(Vec3{1.0, 0.3 * unit(random), 0.3 * unit(random)});
      const double weight = unit(random);
      mean.add(d, weight);
      flipped.add(random() % 2 == 0 ? -d * 4.0 : d * 0.5, weight);
    }
    const auto a = mean.result(), b = flipped.result();
    EXPECT_EQ(a.direction, b.direction);
    EXPECT_EQ(a.gap, b.gap);
  }
}

// Two directions at an angle of 2 a to each other, equal weights: the middle, and of the outer products'
// mean the eigenvalues cos^2 a and sin^2 a.
TEST(DirectionMean, IsTheMiddleOfTwoAndSaysHowWellItIsDefined) {
  for (const double a : {0.0, 0.2, 0.7, 0.25 * M_PI - 1e-3}) {
    DirectionMean mean;
    mean.add({std::cos(a), std::sin(a), 0.0}, 0.5);
    mean.add({-std::cos(a), std::sin(a), 0.0}, 0.5);  // the other one, its sign turned
    const auto result = mean.result();
    EXPECT_NEAR(std::abs(result.direction.x), 1.0, 1e-12) << a;
    EXPECT_NEAR(result.gap, 1.0 - std::tan(a) * std::tan(a), 1e-14) << a;
  }
  DirectionMean across;
  across.add({1.0, 0.0, 0.0}, 1.0);
  across.add({0.0, 1.0, 0.0}, 1.0);
  EXPECT_EQ(across.result().gap, 0.0);
  EXPECT_EQ(DirectionMean().result().gap, 0.0);
}

}  // namespace
}  // namespace palpate
