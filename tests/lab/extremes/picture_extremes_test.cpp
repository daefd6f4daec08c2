// Rows of the catalogue of extreme cases that are pictures.

#include <gtest/gtest.h>

#include "lab/extremes/extreme.h"

namespace palpate::test {
namespace {

TEST(PictureExtremes, Hold) {
  for (const Extreme& row : extremes({ExtremeKind::kVolume, ExtremeKind::kLens, ExtremeKind::kCamera})) {
    const StabilityCase found = measured(row);
    EXPECT_TRUE(found.row.holds) << found.row.name << ": " << found.row.measured << " " << found.unit;
  }
}

}  // namespace
}  // namespace palpate::test
