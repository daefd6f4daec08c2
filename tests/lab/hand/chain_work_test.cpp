// What chains yield on closed loops: the plain sum of springs is seen to make energy, the consistent form
// not.

#include "lab/hand/chain/chain_work.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

const ChainWork& measured() {
  static const ChainWork work = run_chain_work(Effort::kQuick, nullptr);
  return work;
}

TEST(ChainWork, FindsNoYieldInTheFormThatHandsFeel) {
  int rows = 0;
  for (const ChainWorkRow& row : measured().rows) {
    if (row.form != kDefaultChainForceForm) continue;
    EXPECT_LE(row.yield, kYieldLimit) << row.chain << " " << row.angle;
    EXPECT_GT(row.turns, 0);
    ++rows;
  }
  EXPECT_GE(rows, 20);
  for (const StabilityCase& c : chain_work_cases(measured())) EXPECT_TRUE(c.row.holds) << c.row.name;
}

// The curl of the sum is k sin(angle) cos(angle): so goes what a loop yields, largest at 45 degrees.
TEST(ChainWork, FindsTheYieldOfThePlainSum) {
  const auto yield_at = [](double angle) {
    for (const ChainWorkRow& row : measured().rows) {
      if (row.form == ChainForceForm::kSum && row.angle == angle && row.chain == "line, then plane") {
        return row.yield;
      }
    }
    return -1.0;
  };
  EXPECT_GT(yield_at(45.0), 0.5);
  const auto expected = [](double degrees) { return std::sin(2.0 * degrees * std::numbers::pi / 180.0); };
  // The energy of the springs, by which it is divided, changes with the angle too, but not much near 0.
  EXPECT_NEAR(yield_at(5.0) / yield_at(10.0), expected(5.0) / expected(10.0), 0.02);
  for (const ChainWorkRow& row : measured().rows) {
    if (row.form == ChainForceForm::kSum && row.chain.find("then circle") != std::string::npos) {
      EXPECT_GT(row.yield, 0.5) << row.chain;
      EXPECT_NEAR(row.taken, row.yield, 1e-3) << "the other way round it takes as much";
    }
  }
}

TEST(ChainWork, FindsThatFrictionTakes) {
  for (const ChainWorkRow& row : measured().rows) {
    if (row.chain.find("drag") == std::string::npos && row.chain.find("tick") == std::string::npos) continue;
    EXPECT_EQ(row.yield, 0.0) << row.chain;
    EXPECT_GT(row.taken, 0.1) << row.chain;
  }
}

TEST(ChainWork, TellsTheReport) {
  const ReportSection section = chain_work_section(measured());
  EXPECT_EQ(section.table.size(), measured().rows.size());
  EXPECT_EQ(section.work_precision.size(), measured().rows.size());
  for (const auto& row : section.table) EXPECT_EQ(row.size(), section.columns.size());
  EXPECT_NE(section.plots.at(0).content.find("consistent, weak"), std::string::npos);
}

}  // namespace
}  // namespace palpate::test
