#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "lab/hand/wall/wall_run.h"

namespace palpate::test {
namespace {

constexpr double kTick = 0.001;  // [s]
constexpr double kFloor = 1e-6;

template <typename Function>
Oscillation swing_of(const Function& x) {
  std::vector<double> samples;
  for (int n = 0; n < 4000; ++n) samples.push_back(x(kTick * n));
  return find_oscillation(samples, kTick, kFloor);
}

double wave(double t, double frequency) { return std::sin(2.0 * std::numbers::pi * frequency * t); }

TEST(LimitCycle, IsWhatNeitherGrowsNorDiesOut) {
  const Oscillation swing = swing_of([](double t) { return 0.3 + 2e-3 * wave(t, 31.7); });
  EXPECT_TRUE(swing.sustained);
  EXPECT_NEAR(swing.amplitude, 2e-3, 2e-5);
  EXPECT_NEAR(swing.frequency, 31.7, 0.05);
}

TEST(LimitCycle, IsNoneWhereTheSwingDiesOutOrIsTooSmall) {
  // Over the second between the quarters the swing falls to e^-0.1, or to e^-0.02.
  EXPECT_FALSE(swing_of([](double t) { return std::exp(-0.1 * t) * wave(t, 20.0); }).sustained);
  EXPECT_TRUE(swing_of([](double t) { return std::exp(-0.02 * t) * wave(t, 20.0); }).sustained);
  EXPECT_TRUE(swing_of([](double t) { return std::exp(0.5 * t) * wave(t, 20.0); }).sustained);
  EXPECT_FALSE(swing_of([](double t) { return 0.4 * kFloor * wave(t, 20.0); }).sustained);
  EXPECT_TRUE(swing_of([](double t) { return 0.6 * kFloor * wave(t, 20.0); }).sustained);
  EXPECT_FALSE(swing_of([](double) { return 7.0; }).sustained);
}

TEST(LimitCycle, CountsNoRippleAsASwing) {
  const Oscillation swing = swing_of([](double t) { return wave(t, 10.0) + 0.05 * wave(t, 333.0); });
  EXPECT_NEAR(swing.frequency, 10.0, 0.1);
}

TEST(LimitCycle, NeedsSamples) {
  EXPECT_FALSE(find_oscillation({}, kTick, kFloor).sustained);
  const std::vector<double> few{1.0, -1.0, 1.0};
  EXPECT_FALSE(find_oscillation(few, kTick, kFloor).sustained);
}

}  // namespace
}  // namespace palpate::test
