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
  std::set<std::string> names;
  for (const StabilityCase& c : cases) {
    EXPECT_TRUE(c.row.holds) << c.row.name << ": " << c.row.measured << ", limit " << c.row.limit;
    names.insert(c.row.name);
  }
  EXPECT_EQ(names.size(), cases.size());
  EXPECT_EQ(cases.size(), 6U);
}

}  // namespace
}  // namespace palpate::test
