#include "lab/hand/wall/stability_sweep.h"

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

TEST(StabilitySweep, FindsTheBoundsAndWhatGoesBeyondThem) {
  const WallStability wall = run_wall_stability(0, nullptr);
  for (const StabilityCase& c : wall.cases) EXPECT_TRUE(c.row.holds) << c.row.name << " " << c.row.measured;
  ASSERT_EQ(wall.sweeps.size(), 4U);
  for (const StiffnessSweep& sweep : wall.sweeps) {
    const bool encoder = sweep.name == "encoder step";
    for (const StiffnessRow& row : sweep.rows) {
      SCOPED_TRACE(sweep.name + " " + std::to_string(row.value));
      // Friction goes with the encoder's steps, and quiets what they feed.
      EXPECT_GT(row.unheld, 0.95 * row.bound);
      if (!encoder) {
        EXPECT_LT(row.unheld, 1.05 * row.bound);
      }
      EXPECT_GT(row.relaxed, 1.1 * row.unheld);
      EXPECT_GT(row.firm, 1.2 * row.relaxed);
      EXPECT_GT(row.controlled, 0.9 * row.unheld) << "late, in a loop with delay, but no worse than that";
      if (sweep.name == "damping of the arm") {
        EXPECT_GT(row.controlled, 2.0 * row.unheld);
      }
    }
  }
  for (const LedgerRow& row : wall.ledger) {
    const bool beyond = row.wall.stiffness > row.bound;
    EXPECT_EQ(row.run.swing.sustained, beyond && !row.wall.controlled) << row.wall.stiffness;
  }
  const std::vector<ReportSection> sections = wall_sections(wall);
  ASSERT_EQ(sections.size(), 2U);
  EXPECT_EQ(sections[0].plots.size(), 4U);
  for (const ReportSection& section : sections) {
    EXPECT_FALSE(section.measurements.empty());
    for (const auto& row : section.table) EXPECT_EQ(row.size(), section.columns.size());
  }
}

}  // namespace
}  // namespace palpate::test
