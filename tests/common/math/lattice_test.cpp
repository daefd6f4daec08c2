// Lattices stand x fastest: the place of a point by its indices.

#include "common/math/lattice.h"

#include <cstddef>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

TEST(Lattice, PointsStandOneAfterAnotherXFastest) {
  const Index3 n{2, 3, 5};
  std::size_t next = 0;
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x) EXPECT_EQ(index_in(n, {x, y, z}), next++);
  EXPECT_EQ(count_of(n), next);
}

TEST(Lattice, HasNoPointsWhereAnAxisHasNone) {
  EXPECT_EQ(count_of({2, 0, 5}), 0U);
  EXPECT_EQ(count_of({-2, -3, 5}), 0U);
}

// 2048^3 points overflow 32 bits.
TEST(Lattice, CountsBeyondThirtyTwoBits) {
  EXPECT_EQ(count_of({2048, 2048, 2048}), std::size_t{1} << 33U);
  EXPECT_EQ(index_in({2048, 2048, 2048}, {0, 0, 2047}), std::size_t{2047} << 22U);
}

}  // namespace
}  // namespace palpate::test
