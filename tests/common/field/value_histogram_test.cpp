#include "common/field/value_histogram.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace palpate {
namespace {

ValueHistogram histogram_of(const std::vector<double>& values, double lower, double upper, std::size_t bins,
                            int threads = 1) {
  return count_values(
      values.size(), [&](std::size_t i) { return values[i]; }, lower, upper, bins, threads);
}

TEST(ValueHistogram, CountsFiniteValuesAndThoseAtTheUpperEndToo) {
  const ValueHistogram h = histogram_of({0.0, 0.9, 1.0, 2.5, 4.0, NAN, HUGE_VAL, -1.0, 4.1}, 0.0, 4.0, 4);
  EXPECT_EQ(h.counts, (std::vector<std::uint64_t>{2, 1, 1, 1}));
  EXPECT_EQ(h.total, 5U);
  EXPECT_EQ(h.value_of(0), 0.5);
  EXPECT_EQ(h.value_of(3), 3.5);
}

TEST(ValueHistogram, TheWholeRangeOfDoublesFits) {
  const double most = std::numeric_limits<double>::max();
  const ValueHistogram h = histogram_of({-most, 0.0, most}, -most, most, 2);
  EXPECT_EQ(h.counts, (std::vector<std::uint64_t>{1, 2}));
}

TEST(ValueHistogram, DoesNotDependOnTheNumberOfThreads) {
  std::vector<double> values(3'000'000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(static_cast<double>(i));
  EXPECT_EQ(histogram_of(values, -1.0, 1.0, 100, 1).counts, histogram_of(values, -1.0, 1.0, 100, 3).counts);
}

ValueHistogram bulk_of(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return bulk_histogram([&](double lower, double upper) { return histogram_of(values, lower, upper, 1024); },
                        *low, *high);
}

TEST(BulkHistogram, AVoxelFarFromAllOthersDoesNotFlattenIt) {
  std::vector<double> values(4000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i % 100);
  for (const double far : {1e20, -1e20, 3e38}) {
    values[17] = far;
    const ValueHistogram bulk = bulk_of(values);
    EXPECT_LE(bulk.upper, 99.0 + 1e-3 * 99.0 + 300.0) << far;
    EXPECT_GE(bulk.lower, -300.0) << far;
    EXPECT_GE(bulk.total, 3999U) << far;
  }
}

TEST(BulkHistogram, WhatIsRareBesideOneValueStays) {
  std::vector<double> values(10'000, 0.0);
  for (std::size_t i = 0; i < 5; ++i) values[1000 * i] = 1.0;
  EXPECT_EQ(bulk_of(values).upper, 1.0);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = i % 7 == 0 ? 1000.0 : static_cast<double>(i % 5);
  EXPECT_EQ(bulk_of(values).upper, 1000.0) << "a seventh is not rare";
}

// Two heaps of equal width: every border in the empty bins between them parts them equally well.
TEST(OtsuThreshold, PartsTwoHeapsInTheMiddleOfTheGap) {
  std::vector<double> values(900, 1.5);
  values.insert(values.end(), 100, 8.5);
  EXPECT_EQ(otsu_threshold(histogram_of(values, 0.0, 10.0, 10)), 5.0);
}

TEST(OtsuThreshold, IsTheLowerEndWhereNothingIsToBeParted) {
  EXPECT_EQ(otsu_threshold(histogram_of({3.0, 3.0}, 3.0, 3.0, 8)), 3.0);
  EXPECT_EQ(otsu_threshold(histogram_of({}, 1.0, 2.0, 8)), 1.0);
}

TEST(MeanBelow, IsThatOfTheBinsBelow) {
  const ValueHistogram h = histogram_of({0.5, 0.5, 3.5, 9.5}, 0.0, 10.0, 10);
  EXPECT_EQ(mean_below(h, 9.0), 1.5);
  EXPECT_EQ(mean_below(h, 0.0), 0.0);
}

TEST(ValueBelowWhich, CountsFromTheGivenValueOn) {
  std::vector<double> values(100);
  std::iota(values.begin(), values.end(), 0.5);  // 0.5, 1.5, …, 99.5
  const ValueHistogram h = histogram_of(values, 0.0, 100.0, 100);
  EXPECT_EQ(value_below_which(h, 0.5, 0.0), 49.5);
  EXPECT_EQ(value_below_which(h, 0.5, 80.0), 89.5);
  EXPECT_EQ(value_below_which(h, 1.0, 0.0), 99.5);
  EXPECT_EQ(value_below_which(h, 0.5, 200.0), 100.0);
}

TEST(ValueHistogram, TellsThePlaceOfAValue) {
  // Half of all below 1, none between 1 and 3, the rest evenly up to 4.
  const ValueHistogram h{0.0, 4.0, {50, 0, 0, 50}, 100};
  EXPECT_EQ(part_below(h, -1.0), 0.0);
  EXPECT_EQ(part_below(h, 0.0), 0.0);
  EXPECT_EQ(part_below(h, 0.5), 0.25);
  EXPECT_EQ(part_below(h, 2.2), 0.5);
  EXPECT_EQ(part_below(h, 3.5), 0.75);
  EXPECT_EQ(part_below(h, 4.0), 1.0);
  EXPECT_EQ(part_below(h, 9.0), 1.0);
  EXPECT_EQ(part_below(h, NAN), 0.0);
  EXPECT_EQ(part_below({2.0, 2.0, {7}, 7}, 2.0), 0.0) << "one value alone";
  EXPECT_EQ(part_below({2.0, 2.0, {7}, 7}, 2.1), 1.0);
}

}  // namespace
}  // namespace palpate
