// Regions of tracts as text: what is read, what is refused, what they hold, and what is written of them.

#include "apps/dtmri/region_text.h"

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

bool holds(const std::string& text, const Vec3& x) {
  return tract_region(parse_region(text, "refused")).contains(x);
}

TEST(RegionText, HoldsWhatItSays) {
  EXPECT_TRUE(holds("sphere:1,2,3,2", {1.0, 2.0, 5.0}));
  EXPECT_FALSE(holds("sphere:1,2,3,2", {1.0, 2.0, 5.01}));
  EXPECT_TRUE(holds("box:1,1,1,-1,-2,-3", {0.0, -2.0, 1.0}));
  EXPECT_FALSE(holds("box:1,1,1,-1,-2,-3", {0.0, -2.1, 1.0}));
  EXPECT_TRUE(holds("beyond:2,0,0,2", {1.1, 9.0, 9.0})) << "the normal need not be unit";
  EXPECT_FALSE(holds("beyond:2,0,0,2", {0.9, 9.0, 9.0}));
  EXPECT_TRUE(holds("brush:1,0,0,0,5,0,0", {5.5, 0.0, 0.0}));
  EXPECT_FALSE(holds("brush:1,0,0,0,5,0,0", {2.5, 0.0, 0.0}));
}

TEST(RegionText, ComesBackFromItsText) {
  for (const char* text : {"sphere:1,-2.5,3,0.1", "box:-1,-2,-3,1,1,1", "beyond:0,0,1,4.5",
                           "brush:0.25,0,0,0,5,1,2", "mask:a b.nii.gz"})
    EXPECT_EQ(region_text(parse_region(text, "refused")), text);
}

TEST(RegionText, RefusesWhatIsNone) {
  for (const char* text : {"", "sphere:", "sphere:1,2,3", "sphere:1,2,3,0", "box:1,2,3", "beyond:0,0,0,1",
                           "brush:1", "brush:1,2,3", "brush:0,1,2,3", "ball:1,2,3,4", "mask:"})
    EXPECT_THROW((void)parse_region(text, "refused"), Error) << text;
}

TEST(RegionText, RolesGoIntoTheirOptionsAndBack) {
  TractTracingOptions options;
  options.seeds = "fa:0.5";
  options.include = {"sphere:0,0,0,1"};
  std::vector<RegionEntry> regions = regions_of(options);
  ASSERT_EQ(regions.size(), 1U) << "seeds by anisotropy are no region";
  regions.front().role = RegionRole::kExclude;
  set_regions(regions, options);
  EXPECT_EQ(options.seeds, "fa:0.5");
  EXPECT_TRUE(options.include.empty());
  EXPECT_EQ(options.exclude, std::vector<std::string>{"sphere:0,0,0,1"});
  regions.push_back({RegionRole::kSeed, "box:0,0,0,1,1,1"});
  set_regions(regions, options);
  EXPECT_EQ(options.seeds, "box:0,0,0,1,1,1");
  EXPECT_EQ(region_views(options).size(), 2U);
}

TEST(RegionText, IsWrittenAsATable) {
  const TempFolder folder;
  TractTracingOptions options;
  EXPECT_THROW((void)write_regions(folder.path("none.csv"), options, false, {}, {}, true), Error);
  options.stop = {"sphere:0,0,0,1"};
  (void)write_regions(folder.path("r.csv"), options, false, {}, {}, true);
  std::ifstream in(folder.path("r.csv"));
  std::stringstream text;
  text << in.rdbuf();
  EXPECT_EQ(text.str(), "role,region\nstop,\"sphere:0,0,0,1\"\n");
}

}  // namespace
}  // namespace palpate::test
