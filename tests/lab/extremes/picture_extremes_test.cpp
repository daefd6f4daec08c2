// Rows of the catalogue of extreme cases that are pictures.

#include <gtest/gtest.h>

#include "lab/extremes/extreme.h"

namespace palpate::test {
namespace {

TEST(PictureExtremes, Hold) {
  for (const Extreme& row : extremes({ExtremeKind::kVolume, ExtremeKind::kLens, ExtremeKind::kCamera})) {
    const StabilityCase found = measured(row);
    EXPECT_TRUE(found.row.holds) << found.row.name << ": " << found.row.measured << " " << found.unit;
    if (row.unguarded) {
      EXPECT_GT(row.unguarded(), row.limit) << row.name << " needs no guard";
    }
  }
}

}  // namespace
}  // namespace palpate::test
