#include "lab/hand/wall/wall_extremes.h"

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

TEST(WallExtremes, HoldByTheirGuardsAndNotWithout) {
  const std::vector<WallExtreme> rows = wall_extremes();
  EXPECT_GE(rows.size(), 15U);
  for (const WallExtreme& row : rows) {
    const StabilityRow& held = row.held.row;
    EXPECT_TRUE(held.holds) << held.name << ": " << held.measured;
    EXPECT_GT(row.unguarded, held.limit) << held.name << " needs no guard";
  }
}

}  // namespace
}  // namespace palpate::test
