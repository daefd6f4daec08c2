// A line that one thread grows and another one reads. Run under ThreadSanitizer too.

#include "common/trace/live_line.h"

#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/common/trace/helix_field.h"
#include "tests/support/allocation_guard.h"

namespace palpate::test {
namespace {

using Side = GrowingLine::Side;

void grow(LiveLine& live, int pieces) {
  for (int i = 0; i < pieces; ++i) {
    (void)live.current()->grow(Side::kDownstream);
    (void)live.current()->grow(Side::kUpstream);
  }
}

std::vector<Vec3> positions(const GrowingLine& line) {
  std::vector<Vec3> result;
  for (int i = line.first(); i <= line.last(); ++i) result.push_back(line.node(i).position);
  return result;
}

TEST(LiveLine, IsNoLineUntilItIsStartedAndAfterItIsDropped) {
  LiveLine live(helix_flow(0.1), 1e-7, 1);
  const auto look = [&] {
    std::pair<bool, std::uint64_t> seen{false, 7};
    live.read([&](const GrowingLine* line, std::uint64_t number) { seen = {line != nullptr, number}; });
    return seen;
  };
  EXPECT_EQ(live.current(), nullptr);
  EXPECT_EQ(look(), std::pair(false, std::uint64_t{0}));
  EXPECT_FALSE(live.start({9.0, 0.0, 0.0})) << "outside";
  EXPECT_EQ(look(), std::pair(false, std::uint64_t{0}));
  ASSERT_TRUE(live.start({1.0, 0.0, 0.0}));
  const auto [there, first] = look();
  EXPECT_TRUE(there);
  EXPECT_GT(first, 0U);
  EXPECT_FALSE(live.start({9.0, 0.0, 0.0}));
  EXPECT_EQ(look(), std::pair(true, first)) << "what was there stays";
  ASSERT_TRUE(live.start({1.0, 0.0, 0.0}));
  EXPECT_NE(look().second, first) << "the same seed is another line";
  live.drop();
  EXPECT_EQ(live.current(), nullptr);
  EXPECT_EQ(look(), std::pair(false, std::uint64_t{0}));
}

TEST(LiveLine, WhatIsBeingReadIsNotChangedByNewLines) {
  LiveLine live(helix_flow(0.1), 1e-7, 1);
  ASSERT_TRUE(live.start({1.0, 0.0, 0.0}));
  grow(live, 5);
  live.read([&](const GrowingLine* line, std::uint64_t) {
    const std::vector<Vec3> before = positions(*line);
    for (int i = 0; i < 7; ++i) {
      ASSERT_TRUE(live.start({0.5 + 0.1 * i, 0.0, 0.0}));
      EXPECT_NE(live.current(), line);
      grow(live, 5);
    }
    EXPECT_EQ(positions(*line), before);
    live.drop();
    ASSERT_TRUE(live.start({0.2, 0.0, 0.0}));
    EXPECT_EQ(positions(*line), before);
  });
}

// Each line goes about the axis at the radius of its seed, which tells lines apart.
TEST(LiveLine, AReaderBesideTheServoSeesWholeLinesOnly) {
  LiveLine live(helix_flow(0.1), 1e-5, 1);
  constexpr int kLines = 2000;
  const auto radius_of = [](std::uint64_t number) { return 0.5 + 1e-3 * static_cast<double>(number % 1000); };
  std::atomic<bool> done{false};
  std::jthread servo([&] {
    for (std::uint64_t number = 1; number <= kLines; ++number) {
      if (!live.start({radius_of(number), 0.0, 0.0})) break;
      grow(live, static_cast<int>(number % 7));
      if (number % 50 == 0) live.drop();
    }
    done = true;
  });
  std::uint64_t looks = 0, latest = 0, wrong = 0;
  while (!done) {
    live.read([&](const GrowingLine* line, std::uint64_t number) {
      if (line == nullptr) return;
      ++looks;
      wrong += number < latest ? 1 : 0;
      latest = number;
      for (int again = 0; again < 3; ++again) {
        const int first = line->first(), last = line->last();
        for (int i = first; i <= last; ++i) {
          const Vec3 x = line->node(i).position;
          wrong += std::abs(std::hypot(x.x, x.y) - radius_of(number)) > 1e-4 ? 1 : 0;
        }
      }
    });
  }
  servo.join();
  EXPECT_EQ(wrong, 0U);
  EXPECT_GE(live.limits().max_length, live.field().diagonal());
}

TEST(LiveLine, AllocatesNothingOnceItIsMade) {
  LiveLine live(helix_flow(0.1), 1e-7, 1);
  const AllocationGuard guard;
  bool started = true;
  for (int i = 0; i < 10; ++i) {
    started = live.start({0.5 + 0.1 * i, 0.0, 0.0}) && started;
    grow(live, 20);
  }
  live.drop();
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_TRUE(started);
}

}  // namespace
}  // namespace palpate::test
