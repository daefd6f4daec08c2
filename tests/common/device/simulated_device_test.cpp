#include "common/device/simulated_device.h"

#include <cmath>
#include <thread>

#include <gtest/gtest.h>

#include "common/device/mouse_device.h"
#include "common/device/replay_device.h"
#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

constexpr double kTick = 0.001;  // [s]

std::vector<DeviceSample> circle() {
  std::vector<DeviceSample> samples;
  for (int n = 0; n < 3000; ++n) {
    const double angle = 2e-3 * n;
    samples.push_back({kTick * n, {0.03 * std::cos(angle), 0.03 * std::sin(angle), 0.0}, 1});
  }
  return samples;
}

TEST(SimulatedDevice, FollowsItsLeaderWithinTheOperatorsLag) {
  ReplayDevice leader(circle());
  SimulatedDevice device({.profile = find_profile("premium3"), .hand = kFirmHand}, leader);
  DeviceSample sample;
  double farthest = 0.0;
  for (int n = 0; n < 3000; ++n) {
    ASSERT_TRUE(device.read(100.0 + kTick * n, sample));
    EXPECT_EQ(sample.buttons, 1U);
    EXPECT_EQ(sample.time, 100.0 + kTick * n);
    farthest = std::max(farthest, glm::distance(sample.position, device.target()));
  }
  // 0.3 s of reaction and lag at 60 mm/s, and what friction and the mass add.
  EXPECT_GT(farthest, 0.010);
  EXPECT_LT(farthest, 0.025);
  EXPECT_FALSE(device.read(200.0, sample)) << "the path is over, and nobody wanders";
}

TEST(SimulatedDevice, GivesTheSameBitsForTheSameTimes) {
  const auto run = [] {
    ReplayDevice leader(circle());
    SimulatedDevice device({.profile = find_profile("falcon")}, leader);
    DeviceSample sample;
    Vec3 sum{0.0};
    for (int n = 0; n < 2000; ++n) {
      (void)device.read(kTick * n, sample);
      device.command(-200.0 * sample.position);
      sum += sample.position * (1.0 + n);
    }
    return sum;
  };
  EXPECT_EQ(run(), run());
}

TEST(SimulatedDevice, FeelsWhatItIsCommanded) {
  MouseDevice mouse;
  mouse.grab(0.0, Vec3{0.0}, 0);
  SimulatedDevice device(
      {.profile = find_profile("ideal"), .hand = kRelaxedHand, .operator_settings = {.tremor = 0.0}}, mouse);
  DeviceSample sample;
  for (int n = 0; n < 3000; ++n) {
    ASSERT_TRUE(device.read(kTick * n, sample));
    device.command({0.8, 0.0, 0.0});
  }
  EXPECT_NEAR(sample.position.x, 0.8 / kRelaxedHand.stiffness, 1e-6) << "the hand gives by F / k";
  device.emergency_stop();
  for (int n = 3000; n < 6000; ++n) ASSERT_TRUE(device.read(kTick * n, sample));
  EXPECT_NEAR(sample.position.x, 0.0, 1e-6);
  device.command({0.8, 0.0, 0.0});
  ASSERT_TRUE(device.read(6.0, sample));
  ASSERT_TRUE(device.read(6.01, sample));
  EXPECT_GT(sample.position.x, 1e-5) << "the next command counts again";
}

TEST(SimulatedDevice, WandersWithinItsReachWhileNobodyLeads) {
  MouseDevice mouse;
  const WanderingPath path{.center = {0.1, 0.2, 0.3}, .reach = {0.01, 0.02, 0.03}};
  SimulatedDevice device({.profile = find_profile("ideal"), .hand = kFirmHand, .wander = path}, mouse);
  DeviceSample sample;
  Vec3 lowest{HUGE_VAL}, highest{-HUGE_VAL};
  for (int n = 0; n < 40'000; ++n) {
    ASSERT_TRUE(device.read(kTick * n, sample));
    lowest = glm::min(lowest, sample.position);
    highest = glm::max(highest, sample.position);
  }
  for (int a = 0; a < 3; ++a) {
    EXPECT_NEAR(lowest[a], path.center[a] - path.reach[a], 0.15 * path.reach[a] + 3e-4);
    EXPECT_NEAR(highest[a], path.center[a] + path.reach[a], 0.15 * path.reach[a] + 3e-4);
  }
}

TEST(SimulatedDevice, IsStoppedFromAnotherThread) {
  MouseDevice mouse;
  SimulatedDevice device({.profile = find_profile("ideal"), .wander = WanderingPath{}}, mouse);
  std::jthread watchdog([&device](const std::stop_token& stop) {
    while (!stop.stop_requested()) device.emergency_stop();
  });
  DeviceSample sample;
  for (int n = 0; n < 5000; ++n) {
    ASSERT_TRUE(device.read(kTick * n, sample));
    device.command({1.0, 0.0, 0.0});
  }
}

TEST(SimulatedDevice, AllocatesNothing) {
  MouseDevice mouse;
  SimulatedDevice device({.profile = find_profile("falcon"), .wander = WanderingPath{}}, mouse);
  DeviceSample sample;
  const AllocationGuard guard;
  for (int n = 0; n < 1000; ++n) {
    (void)device.read(kTick * n, sample);
    device.command(Vec3{0.1});
  }
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace palpate::test
