#include "common/servo/time_histogram.h"

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

TEST(TimeHistogram, IsExactBelowSixteenNanoseconds) {
  TimeHistogram histogram;
  EXPECT_EQ(histogram.percentile_ns(0.5), 0U);
  for (int ns = 1; ns <= 15; ++ns) histogram.add(ns);
  EXPECT_EQ(histogram.percentile_ns(0.0), 1U);
  EXPECT_EQ(histogram.percentile_ns(0.5), 8U);
  EXPECT_EQ(histogram.percentile_ns(1.0), 15U);
  histogram.add(-5);
  EXPECT_EQ(histogram.percentile_ns(0.0), 0U);
  EXPECT_EQ(histogram.count(), 16U);
}

// Against sorting, over nine decades: never below the true percentile, and above by one bin of an eighth at
// most.
TEST(TimeHistogram, KnowsPercentilesToTheWidthOfItsBins) {
  std::mt19937_64 random{4};
  std::uniform_real_distribution<double> exponent(0.0, 9.0);
  TimeHistogram histogram;
  std::vector<std::uint64_t> sorted;
  for (int i = 0; i < 10'000; ++i) {
    sorted.push_back(static_cast<std::uint64_t>(std::pow(10.0, exponent(random))));
    histogram.add(static_cast<std::int64_t>(sorted.back()));
  }
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(histogram.max_ns(), sorted.back());
  for (const double p : {0.01, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const auto rank = static_cast<std::size_t>(std::ceil(p * 10'000.0)) - 1;
    const auto exact = static_cast<double>(sorted[rank]);
    const auto found = static_cast<double>(histogram.percentile_ns(p));
    EXPECT_GE(found, exact) << p;
    EXPECT_LE(found, 1.125 * exact) << p;
  }
}

TEST(TimeHistogram, TakesTheLongestTimeThereIs) {
  TimeHistogram histogram;
  histogram.add(std::int64_t{1} << 62);
  EXPECT_EQ(histogram.max_ns(), std::uint64_t{1} << 62U);
  EXPECT_GT(histogram.percentile_ns(0.5), std::uint64_t{1} << 36U);
}

}  // namespace
}  // namespace palpate::test
