#include "common/math/double_double.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace palpate {
namespace {

// Held against whole numbers that a double cannot hold.
TEST(DoubleDouble, KeepsTwiceTheDigits) {
  const DoubleDouble x = DoubleDouble(0x1p60) + 1.0, y = DoubleDouble(0x1p60) - 1.0;
  EXPECT_EQ(x - 0x1p60, DoubleDouble(1.0));
  EXPECT_EQ(x - y, DoubleDouble(2.0));
  // (2^50 + 1) (2^50 - 1) = 2^100 - 1
  EXPECT_EQ(DoubleDouble(0x1p50 + 1.0) * DoubleDouble(0x1p50 - 1.0) - 0x1p100, DoubleDouble(-1.0));
  EXPECT_EQ(DoubleDouble(-3.0) < DoubleDouble(2.0), true);
  EXPECT_EQ(abs(DoubleDouble(-3.0)), DoubleDouble(3.0));
}

TEST(DoubleDouble, QuotientsAndRootsAreInvertedByProducts) {
  std::mt19937_64 random{1};
  std::uniform_real_distribution<double> unit(0.5, 2.0);
  for (int n = 0; n < 1000; ++n) {
    const DoubleDouble x = DoubleDouble(unit(random)) + 0x1p-60 * unit(random);
    const DoubleDouble y = DoubleDouble(unit(random)) - 0x1p-60 * unit(random);
    EXPECT_LE(std::abs(static_cast<double>(x / y * y - x)), 0x1p-101);
    EXPECT_LE(std::abs(static_cast<double>(sqrt(x) * sqrt(x) - x)), 0x1p-101);
  }
}

}  // namespace
}  // namespace palpate
