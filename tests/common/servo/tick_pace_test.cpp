// When the servo ticks beside devices of any rate, in simulated time.

#include "common/servo/tick_pace.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

constexpr std::int64_t kPeriod = 1'000'000;  // [ns]
constexpr std::int64_t kTick = 50'000;       // [ns] that a tick is at work
constexpr double kSeconds = 20.0;

struct Course {
  std::vector<std::int64_t> ticks;   ///< when each began
  std::vector<std::int64_t> delays;  ///< from a sample to the device's command that its force is first in
  int late = 0;                      ///< ticks that waited for a sample that did not come

  [[nodiscard]] double rate() const {
    return 1e9 * static_cast<double>(ticks.size() - 1) / static_cast<double>(ticks.back() - ticks.front());
  }
  [[nodiscard]] std::int64_t delay(double part) const {
    std::vector<std::int64_t> sorted = delays;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
  }
};

/// The samples of a device come every `interval` [ns], uneven by up to `jitter` of it; each command goes out right
/// before the next one.
Course run(double interval, double jitter, bool follows, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  std::vector<std::int64_t> samples;
  const double phase = 0.5 + 0.5 * part(random);
  for (double n = 0.0; n * interval < 1.01e9 * kSeconds; ++n)
    samples.push_back(std::llround((n + 1.0 + phase + jitter * part(random)) * interval));
  const auto newest = [&](std::int64_t at) {
    const auto after = std::upper_bound(samples.begin(), samples.end(), at);
    return Bell::Rang{static_cast<std::uint32_t>(after - samples.begin()),
                      after == samples.begin() ? 0 : *(after - 1)};
  };
  Course course;
  TickPace pace(kPeriod, 0);
  for (std::int64_t now = 0; static_cast<double>(now) < 1e9 * kSeconds;) {
    const TickPace::Wait wait = pace.next();
    now = std::max(now, wait.from);
    if (follows && pace.awaits(newest(now))) {
      const auto next = std::upper_bound(samples.begin(), samples.end(), now);
      now = std::max(now, std::min(wait.until, next == samples.end() ? wait.until : *next));
      course.late += newest(now).last < wait.from - kPeriod / 4 ? 1 : 0;
    }
    const Bell::Rang sample = newest(now);
    (void)pace.began(follows ? sample : Bell::Rang());
    course.ticks.push_back(now);
    now += kTick;
    const auto command = std::upper_bound(samples.begin(), samples.end(), now);
    if (sample.count != 0 && command != samples.end() && now > 1'000'000'000)
      course.delays.push_back(*command - sample.last);
    (void)pace.ended(now);
  }
  return course;
}

TEST(TickPace, WithADeviceOfItsRateAForceIsThereByTheNextCommand) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    for (const double ratio : {0.95, 0.999, 1.0, 1.003, 1.05}) {
      const Course course = run(ratio * kPeriod, 0.01, true, seed);
      EXPECT_LE(course.delay(0.995), std::llround(1.03 * ratio * kPeriod)) << ratio << " " << seed;
      EXPECT_NEAR(course.rate(), 1000.0 / ratio, 2.0) << ratio << " " << seed;
      EXPECT_EQ(course.late, 0) << ratio << " " << seed;
    }
  }
}

// What it is for: at moments of its own some forces miss the next command, with every phase between the two.
TEST(TickPace, AtItsOwnMomentsForcesMissTheNextCommand) {
  EXPECT_GT(run(1.003 * kPeriod, 0.01, false, 1).delay(0.995), std::llround(1.9 * kPeriod));
}

TEST(TickPace, KeepsItsRateBesideDevicesOfAnyRate) {
  for (double ratio = 0.03; ratio < 20.0; ratio *= 1.13) {
    for (const double jitter : {0.0, 0.02, 0.2}) {
      const Course course = run(ratio * kPeriod, jitter, true, 7);
      const bool alike = std::abs(ratio - 1.0) < 0.13;
      EXPECT_NEAR(course.rate(), 1000.0, alike ? 130.0 : 12.0) << ratio << " " << jitter;
      EXPECT_LE(course.late, static_cast<int>(kSeconds) + 1) << ratio << " " << jitter;
      std::int64_t longest = 0;
      for (std::size_t i = 1; i < course.ticks.size(); ++i)
        longest = std::max(longest, course.ticks[i] - course.ticks[i - 1]);
      EXPECT_LE(longest, 7 * kPeriod / 4) << ratio << " " << jitter;
    }
  }
}

TEST(TickPace, TicksWithoutADevice) {
  const Course course = run(1e15, 0.0, true, 1);
  EXPECT_NEAR(course.rate(), 1000.0, 1e-6);
}

}  // namespace
}  // namespace palpate::test
