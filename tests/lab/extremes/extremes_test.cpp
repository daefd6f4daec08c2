// The catalogue of stiff and extreme cases: every row holds, and docs/extremes.md lists it.

#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "lab/extremes/extreme.h"
#include "tests/support/project_folders.h"

namespace palpate::test {
namespace {

void expect_hold(std::initializer_list<ExtremeKind> kinds) {
  for (const Extreme& row : extremes(kinds)) {
    const StabilityCase found = measured(row);
    EXPECT_TRUE(found.row.holds) << found.row.name << ": " << found.row.measured << " " << found.unit;
  }
}

TEST(Extremes, FieldsAndMeshesHold) { expect_hold({ExtremeKind::kField, ExtremeKind::kMesh}); }
TEST(Extremes, TensorsHold) { expect_hold({ExtremeKind::kTensor}); }
TEST(Extremes, DevicesHold) { expect_hold({ExtremeKind::kDevice}); }

TEST(Extremes, WallsHoldByTheirGuardsAndNotWithout) {
  for (const Extreme& row : extremes({ExtremeKind::kWall})) {
    EXPECT_LE(row.measure(), row.limit) << row.name;
    ASSERT_TRUE(row.unguarded) << row.name;
    EXPECT_GT(row.unguarded(), row.limit) << row.name << " needs no guard";
  }
}

TEST(Extremes, FieldsAndMeshesDoNotHoldWithoutTheGuardsOfTheirRows) {
  int guarded = 0;
  for (const Extreme& row : extremes({ExtremeKind::kField, ExtremeKind::kMesh})) {
    if (!row.unguarded) continue;
    ++guarded;
    EXPECT_GT(row.unguarded(), row.limit) << row.name << " needs no guard";
  }
  EXPECT_GE(guarded, 9);
}

TEST(Extremes, EveryRowWasSeenToFail) {
  for (const Extreme& row : extremes()) EXPECT_FALSE(guard_of(row).empty()) << row.name;
}

TEST(Extremes, AreNamedOnceAndAreMany) {
  std::set<std::string> names;
  const std::vector<Extreme> rows = extremes();
  for (const Extreme& row : rows) {
    EXPECT_TRUE(names.insert(std::string(name_of(row.kind)) + ": " + row.name).second) << row.name;
    EXPECT_FALSE(row.builder.empty() || row.claim.empty() || row.unit.empty()) << row.name;
  }
  EXPECT_GE(rows.size(), 150U);
}

TEST(Extremes, StandOnTheirPage) {
  std::ifstream file(source_folder() / "docs" / "extremes.md");
  std::ostringstream page;
  page << file.rdbuf();
  EXPECT_EQ(page.str(), extremes_page()) << "scripts/extremes_page.sh writes it anew";
}

}  // namespace
}  // namespace palpate::test
