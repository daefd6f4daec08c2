// Where a head will be: exact for constant velocities, and off by what theory says for others.

#include "common/device/pose_prediction.h"

#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/device/pose_source.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

constexpr double kStep = 1.0 / 128.0, kWindow = 6.0 * kStep, kAhead = 0.04;  // [s]

TEST(PosePrediction, IsExactAtConstantVelocityAndTurning) {
  const Vec3 v{0.3, -0.2, 0.5}, turning{0.4, 1.1, -0.7};
  const Quat start = rotation_by({0.3, -1.2, 2.0});
  PosePrediction prediction(kWindow);
  const auto pose = [&](double t) {
    return TrackerPose{Vec3{0.1, 0.2, 0.6} + t * v, rotation_by(t * turning) * start};
  };
  const AllocationGuard guard;
  for (int i = 0; i < 40; ++i) prediction.take(i * kStep, pose(i * kStep));
  const double t = 39 * kStep + kAhead;
  const TrackerPose predicted = prediction.predicted(t);
  EXPECT_EQ(guard.count(), 0);
  EXPECT_LT(glm::distance(predicted.position, pose(t).position), 1e-14);
  EXPECT_LT(angle_of(predicted.orientation * glm::conjugate(pose(t).orientation)), 1e-13);
  EXPECT_LT(glm::distance(prediction.velocity(), v), 1e-13);
  EXPECT_LT(glm::distance(prediction.turning(), turning), 1e-12);
  // Behind the newest sample nothing is predicted, and far ahead no more than kFarthest.
  EXPECT_EQ(prediction.predicted(0.0).position, pose(39 * kStep).position);
  EXPECT_EQ(prediction.predicted(1e3).position,
            prediction.predicted(39 * kStep + PosePrediction::kFarthest).position);
}

TEST(PosePrediction, IsOffByHalfTheAccelerationTimesWhatTheoryAllowsFor) {
  const Vec3 a{2.0, -1.0, 0.5};
  PosePrediction prediction(kWindow);
  for (int i = 0; i < 40; ++i) prediction.take(i * kStep, {0.5 * (i * kStep) * (i * kStep) * a, {}});
  const double t = 39 * kStep + kAhead;
  const Vec3 error = 0.5 * t * t * a - prediction.predicted(t).position;
  EXPECT_LT(glm::distance(error, 0.5 * kAhead * (kAhead + kWindow) * a), 1e-14);
}

// A head that sways, x = sin(2 pi f t): prediction is linear in the samples, so its error sways, too, with
// the amplitude |exp(i w tau) - 1 - tau sum_k c_k exp(-i w t_k)|, c_k the weights of the slope. Holding the
// newest pose is off by |exp(i w tau) - 1|.
TEST(PosePrediction, OfASwayingHeadIsOffByItsTransferFunction) {
  constexpr int kSamples = 7;
  for (const double frequency : {0.25, 0.5, 1.0, 2.0}) {
    const double w = 2.0 * std::numbers::pi * frequency;
    double spread = 0.0;
    for (int k = 0; k < kSamples; ++k) spread += std::pow((3 - k) * kStep, 2);
    std::complex<double> slope{0.0};
    for (int k = 0; k < kSamples; ++k)
      slope += (3 - k) * kStep / spread * std::exp(std::complex<double>(0.0, -w * k * kStep));
    const std::complex<double> truth = std::exp(std::complex<double>(0.0, w * kAhead));
    const double amplitude = std::abs(truth - 1.0 - kAhead * slope), held = std::abs(truth - 1.0);

    PosePrediction prediction(kWindow);
    double worst = 0.0, worst_held = 0.0;
    constexpr int kCount = 4000;  // the peak of the error is met to 1e-4 or better
    for (int i = 0; i < kCount; ++i) {
      const double t = i * kStep;
      prediction.take(t, {{std::sin(w * t), 0.0, 0.0}, {}});
      if (i < kSamples) continue;
      const double there = std::sin(w * (t + kAhead));
      worst = std::max(worst, std::abs(there - prediction.predicted(t + kAhead).position.x));
      worst_held = std::max(worst_held, std::abs(there - std::sin(w * t)));
    }
    EXPECT_NEAR(worst / amplitude, 1.0, 0.01) << frequency;
    EXPECT_NEAR(worst_held / held, 1.0, 0.01) << frequency;
    EXPECT_LT(worst, (frequency < 1.5 ? 0.4 : 0.75) * worst_held) << frequency;
  }
}

TEST(PosePrediction, IsAsNoisyAsTheoryAllowsFor) {
  constexpr double kSigma = 1e-3;
  constexpr int kTrials = 4000;
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0.0, kSigma);
  double square = 0.0;
  for (int i = 0; i < kTrials; ++i) {
    PosePrediction prediction(kWindow);
    for (int k = 0; k < 12; ++k) prediction.take(k * kStep, {{noise(random), 0.0, 0.0}, {}});
    square += std::pow(prediction.predicted(11 * kStep + kAhead).position.x, 2) / kTrials;
  }
  const double n = 7.0, spread = kWindow * kWindow * n * (n + 1.0) / (12.0 * (n - 1.0));
  const double theory = kSigma * kSigma * (1.0 + kAhead * kWindow / spread + kAhead * kAhead / spread);
  EXPECT_NEAR(square / theory, 1.0, 4.0 * std::sqrt(2.0 / kTrials));  // four standard deviations
}

TEST(PosePrediction, BeginsWithWhatItHas) {
  PosePrediction prediction;
  EXPECT_TRUE(prediction.empty());
  prediction.take(1.0, {{1.0, 2.0, 3.0}, {}});
  EXPECT_EQ(prediction.predicted(1.1).position, Vec3(1.0, 2.0, 3.0)) << "one sample has no velocity";
  prediction.take(1.0, {{9.0, 9.0, 9.0}, {}});
  prediction.take(0.5, {{9.0, 9.0, 9.0}, {}});
  EXPECT_EQ(prediction.predicted(1.1).position, Vec3(1.0, 2.0, 3.0)) << "what is not later changes nothing";
  prediction.forget();
  EXPECT_TRUE(prediction.empty());
}

TEST(PoseSource, ReplaysEachSampleOnceAtItsOwnPace) {
  TempFolder folder;
  const auto file = folder.write("head.csv",
                                 "t,x,y,z,qw,qx,qy,qz\n10,0,0,1,1,0,0,0\n10.01,nan,nan,nan,nan,nan,nan,nan\n"
                                 "10.03,1,0,1,0,1,0,0\n");
  ReplayPoses replay(read_poses(file.string()));
  PoseSample sample;
  ASSERT_TRUE(replay.next(2.0, sample));
  EXPECT_EQ(sample.time, 2.0);
  EXPECT_TRUE(sample.pose.has_value());
  EXPECT_FALSE(replay.next(2.005, sample));
  ASSERT_TRUE(replay.next(2.05, sample));
  EXPECT_FALSE(sample.pose.has_value());
  ASSERT_TRUE(replay.next(2.05, sample));
  EXPECT_NEAR(sample.time, 2.03, 1e-12);
  EXPECT_FALSE(replay.next(9.0, sample));
  EXPECT_FALSE(replay.live());

  const auto refusal = [&](const char* text) {
    try {
      (void)read_poses(folder.write("wrong.csv", text).string());
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(refusal("t,x,y,z,qw,qx,qy,qz\n0,0,0,1,2,0,0,0\n").find("length 2"), std::string::npos);
  EXPECT_NE(refusal("t,x,y,z,qw,qx,qy,qz\n1,0,0,1,1,0,0,0\n1,0,0,1,1,0,0,0\n").find("rise"),
            std::string::npos);
  EXPECT_NE(refusal("t,x,y,z,qw,qx,qy,qz\n").find("no row"), std::string::npos);
}

}  // namespace
}  // namespace palpate::test
