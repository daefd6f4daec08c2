#include "common/render/ticks.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palpate {
namespace {

std::vector<std::string> texts(const ValueRange& range, bool logarithmic = false, int most = 6) {
  std::vector<std::string> result;
  for (const Tick& tick : ticks(range, logarithmic, most)) result.push_back(tick.text);
  return result;
}

using Words = std::vector<std::string>;

TEST(Ticks, AreRoundNumbersWithinTheRange) {
  EXPECT_EQ(texts({0.0, 1.0}), (Words{"0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(texts({0.13, 1.07}), (Words{"0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(texts({-50.0, 50.0}), (Words{"-40", "-20", "0", "20", "40"}));
  EXPECT_EQ(texts({0.0, 2500.0}), (Words{"0", "500", "1000", "1500", "2000", "2500"}));
}

TEST(Ticks, HugeAndTinyNumbersGetAnExponent) {
  EXPECT_EQ(texts({0.0, 1e30}), (Words{"0", "2e29", "4e29", "6e29", "8e29", "1e30"}));
  EXPECT_EQ(texts({1e-30, 3e-30}), (Words{"1e-30", "1.5e-30", "2e-30", "2.5e-30", "3e-30"}));
}

TEST(Ticks, DecadesOnALogarithmicScale) {
  EXPECT_EQ(texts({1e-9, 1e-5}, true), (Words{"1e-9", "1e-8", "1e-7", "1e-6", "1e-5"}));
  EXPECT_EQ(texts({1e-12, 1e0}, true), (Words{"1e-12", "1e-9", "1e-6", "1e-3", "1e0"}));
  EXPECT_EQ(texts({0.9, 6.0}, true), (Words{"1", "2", "5"}));
}

TEST(Ticks, RangeWithoutExtentHasOne) {
  EXPECT_EQ(texts({2.5, 2.5}), (Words{"2.5"}));
  EXPECT_TRUE(texts({NAN, 1.0}).empty());
}

TEST(Ticks, ThereAreNeverMoreThanAskedFor) {
  for (double upper = 1e-3; upper < 1e3; upper *= 1.37) {
    for (int most = 2; most < 10; ++most) {
      const auto marks = ticks({-0.3 * upper, upper}, false, most);
      EXPECT_LE(marks.size(), static_cast<std::size_t>(most));
      EXPECT_GE(marks.size(), 1U);
      for (const Tick& tick : marks) {
        EXPECT_GE(tick.value, -0.3 * upper * (1 + 1e-9));
        EXPECT_LE(tick.value, upper * (1 + 1e-9));
      }
      EXPECT_LE(ticks({1e-6 * upper, upper}, true, most).size(), static_cast<std::size_t>(std::max(most, 2)));
    }
  }
}

}  // namespace
}  // namespace palpate
