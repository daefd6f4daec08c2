#include "common/device/mouse_device.h"

#include <cmath>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "common/device/replay_device.h"

namespace palpate::test {
namespace {

constexpr double kTick = 0.001;  // [s] of the servo

Vec3 read_at(MouseDevice& mouse, double now) {
  DeviceSample sample;
  EXPECT_TRUE(mouse.read(now, sample));
  EXPECT_EQ(sample.time, now);
  return sample.position;
}

TEST(MouseDevice, HasNoHandUntilGrabbedAndAfterLettingGo) {
  MouseDevice mouse;
  DeviceSample sample{.time = 7.0};
  EXPECT_FALSE(mouse.read(0.0, sample));
  mouse.move(0.0, {1, 2, 3}, 0);
  EXPECT_FALSE(mouse.read(0.001, sample)) << "a motion without a hold";
  mouse.grab(0.0, {1, 2, 3}, 5);
  ASSERT_TRUE(mouse.read(0.002, sample));
  EXPECT_EQ(sample, (DeviceSample{0.002, {1, 2, 3}, 5}));
  mouse.let_go();
  sample.time = 7.0;
  EXPECT_FALSE(mouse.read(0.003, sample));
  EXPECT_EQ(sample.time, 7.0) << "untouched";
}

TEST(MouseDevice, MovesInAStraightLineOverOneIntervalOfTheWindow) {
  MouseDevice mouse;
  mouse.grab(10.000, {0, 0, 0}, 0);
  EXPECT_EQ(read_at(mouse, 0.0), Vec3(0.0));
  mouse.move(10.020, {0.02, -0.04, 0}, 0);
  EXPECT_EQ(read_at(mouse, 1.000), Vec3(0.0));
  for (const double part : {0.25, 0.5, 0.75}) {
    const Vec3 x = read_at(mouse, 1.000 + 0.020 * part);
    EXPECT_NEAR(x.x, 0.02 * part, 1e-15);
    EXPECT_NEAR(x.y, -0.04 * part, 1e-15);
  }
  EXPECT_EQ(read_at(mouse, 1.0201), Vec3(0.02, -0.04, 0));
  EXPECT_EQ(read_at(mouse, 9.0), Vec3(0.02, -0.04, 0)) << "stays there";
}

// A new grab somewhere else is no motion from where the last one ended.
// Otherwise the leap would be a motion, and a fast one.
TEST(MouseDevice, StartsANewHoldWhereItIsAfterAStepWithoutAHand) {
  MouseDevice mouse;
  mouse.grab(0.0, {0, 0, 0}, 1);
  EXPECT_EQ(read_at(mouse, 0.0), Vec3(0.0));
  mouse.grab(0.01, {0.1, 0, 0}, 0);
  DeviceSample sample;
  EXPECT_FALSE(mouse.read(kTick, sample));
  EXPECT_EQ(read_at(mouse, 2 * kTick), Vec3(0.1, 0.0, 0.0));
  // Let go and taken again between two steps.
  mouse.let_go();
  mouse.grab(0.1, {1, 1, 1}, 0);
  EXPECT_FALSE(mouse.read(3 * kTick, sample));
  EXPECT_EQ(read_at(mouse, 4 * kTick), Vec3(1.0));
}

// Irregular frames, targets that wander and sometimes jump far: each tick stays between the position before
// and the target that was in force, moves no further than an even motion over one interval does, and a target
// that is left alone is reached within one interval.
TEST(MouseDevice, NeverStepsNorOvershoots) {
  std::mt19937 random{5};
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  MouseDevice mouse;
  Vec3 aim{0.0};      // the target in force
  double most = 0.0;  // [m] a tick
  Vec3 last{0.0};
  double now = 0.0;
  double frame = 0.0;
  mouse.grab(now, aim, 0);
  const auto tick = [&] {
    now += kTick;
    const Vec3 x = read_at(mouse, now);
    for (int a = 0; a < 3; ++a) {
      ASSERT_LE(std::abs(x[a] - last[a]) + std::abs(aim[a] - x[a]), std::abs(aim[a] - last[a]) + 1e-13)
          << "beyond the target";
    }
    ASSERT_LE(glm::distance(x, last), most * (1.0 + 1e-6) + 1e-13) << "a step";
    last = x;
  };
  last = read_at(mouse, now);
  for (int k = 0; k < 2000; ++k) {
    const double interval = 0.023 + 0.007 * unit(random);
    frame += interval;
    const Vec3 target = aim + Vec3{unit(random), unit(random), unit(random)} * (k % 50 == 0 ? 10.0 : 0.001);
    mouse.move(frame, target, 0);
    tick();  // sees the target, and starts from where the last motion has come to by now
    aim = target;
    most = glm::distance(last, aim) * kTick / interval;
    for (double passed = 0.0; passed < interval - 2.0 * kTick; passed += kTick) tick();
    if (k % 10 == 0) {
      for (double passed = 0.0; passed < 0.004; passed += kTick) tick();
      ASSERT_EQ(last, aim);
    }
    ASSERT_FALSE(HasFatalFailure());
  }
}

TEST(MouseDevice, IsReadWhileTheWindowMovesIt) {
  MouseDevice mouse;
  std::jthread window([&mouse] {
    for (int i = 0; i < 20'000; ++i) {
      const double x = i;
      if (i % 100 == 0) mouse.grab(x, Vec3{x}, 0);
      mouse.move(x, Vec3{x}, 0);
      if (i % 100 == 99) mouse.let_go();
    }
    mouse.grab(20'000.0, Vec3{20'000.0}, 1);
  });
  DeviceSample sample;
  for (double now = 0.0; sample.buttons == 0; now += kTick) {
    if (!mouse.read(now, sample)) std::this_thread::yield();
    ASSERT_TRUE(sample.position.x == sample.position.y && sample.position.y == sample.position.z);
  }
}

TEST(ReplayDevice, GivesTheNewestSampleThatIsDueOnTheReadersClock) {
  const double nan = std::nan("");
  ReplayDevice device({{5.000, Vec3{1.0}, 0},
                       {5.002, Vec3{2.0}, 1},
                       {nan, Vec3{9.0}, 0},
                       {5.001, Vec3{9.0}, 0},
                       {5.003, Vec3{nan}, 0},
                       {5.004, Vec3{3.0}, 0}},
                      {.stale_after = 0.01});
  DeviceSample sample;
  ASSERT_TRUE(device.read(100.0, sample));
  EXPECT_EQ(sample, (DeviceSample{100.0, Vec3{1.0}, 0}));
  ASSERT_TRUE(device.read(100.0015, sample));
  EXPECT_EQ(sample.position, Vec3(1.0));
  ASSERT_TRUE(device.read(100.0035, sample));
  EXPECT_EQ(sample.position, Vec3(2.0));
  EXPECT_NEAR(sample.time, 100.002, 1e-12);
  EXPECT_EQ(sample.buttons, 1U);
  ASSERT_TRUE(device.read(100.0045, sample));
  EXPECT_EQ(sample.position, Vec3(3.0));
  EXPECT_TRUE(device.read(100.013, sample));
  EXPECT_FALSE(device.read(100.015, sample)) << "the path is over";
  ReplayDevice empty({});
  EXPECT_FALSE(empty.read(0.0, sample));
}

}  // namespace
}  // namespace palpate::test
