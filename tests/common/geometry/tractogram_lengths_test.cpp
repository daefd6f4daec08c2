// Lengths of lines worked by hand.

#include <array>
#include <numeric>

#include <gtest/gtest.h>

#include "common/geometry/tractogram.h"

namespace palpate {
namespace {

TEST(TractogramLengths, AreThoseAlongTheLines) {
  Tractogram lines;
  lines.points = {{0, 0, 0}, {3, 4, 0}, {3, 4, 11}, {1, 1, 1}, {-2, 1, 1}, {-2, 9, 1}};
  lines.starts = {0, 3, 3, 4, 6};  // lengths 16, 0 (no point), 0 (one point), 8
  const TractogramLengths lengths = lengths_of(lines);
  EXPECT_EQ(lengths.least, 0.0);
  EXPECT_EQ(lengths.most, 16.0);
  EXPECT_EQ(lengths.mean, 6.0);
  EXPECT_EQ(lengths.median, 8.0);
  EXPECT_EQ(lengths.bin, 2.0);
  EXPECT_EQ(lengths.histogram, (std::array<std::size_t, 8>{2, 0, 0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(lengths.bounds.lower, Vec3(-2.0, 0.0, 0.0));
  EXPECT_EQ(lengths.bounds.upper, Vec3(3.0, 9.0, 11.0));
}

TEST(TractogramLengths, OfNoLineAreZero) {
  const TractogramLengths lengths = lengths_of({});
  EXPECT_EQ(lengths.most, 0.0);
  EXPECT_EQ(std::accumulate(lengths.histogram.begin(), lengths.histogram.end(), std::size_t{0}), 0U);
}

}  // namespace
}  // namespace palpate
