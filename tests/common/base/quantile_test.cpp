#include "common/base/quantile.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

TEST(Median, IsTheOneInTheMiddleAndTheLargerOfTwo) {
  EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({4.0, 1.0, 3.0, 2.0}), 3.0);
  EXPECT_EQ(median({7.0}), 7.0);
  EXPECT_TRUE(std::isnan(median({})));
}

}  // namespace
}  // namespace palpate::test
