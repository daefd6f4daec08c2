#include "lab/data/volume_extremes.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "tests/common/render/volume/sample_volumes.h"

namespace palpate::test {
namespace {

TEST(VolumeExtremes, HoldOnDataWithShading) {
  VolumeView view = sampled_view(blobs, ScalarType::kFloat32, 25);
  view.shading = true;
  const std::vector<StabilityCase> cases = run_volume_extremes(view, nullptr);
  // Seen along voxels that are much longer than wide, steps are many and thin, and the 16 bits of a table add up (docs/limits.md).
  const std::string beyond = "volume, voxels of 1000 : 1";
  std::set<std::string> names;
  for (const StabilityCase& c : cases) {
    EXPECT_EQ(c.row.holds, c.row.name != beyond)
        << c.row.name << ": " << c.row.measured << ", limit " << c.row.limit;
    EXPECT_LE(c.row.measured, c.row.name == beyond ? 0.02 : c.row.limit) << c.row.name;
    names.insert(c.row.name);
  }
  EXPECT_EQ(names.size(), cases.size());
  EXPECT_GE(cases.size(), 20U);
}

}  // namespace
}  // namespace palpate::test
