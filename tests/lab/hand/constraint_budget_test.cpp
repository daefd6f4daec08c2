// The sweep of every constraint's budget: what is enough is exact, what is not is seen.

#include "lab/hand/constraint/constraint_budget.h"

#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

const ConstraintBudget& measured() {
  static const ConstraintBudget budget = run_constraint_budget(Effort::kQuick, nullptr);
  return budget;
}

TEST(ConstraintBudget, FindsEveryConstraintExactWithTheDefaultBudget) {
  std::map<std::string, BudgetRow> last;
  for (const BudgetRow& row : measured().rows) last[row.constraint] = row;
  EXPECT_EQ(last.size(), budget_subjects().size());
  for (const auto& [name, row] : last) {
    EXPECT_LT(row.force_error.max, 1e-5) << name;  // N
    EXPECT_LT(row.residual.max, 1e-8) << name;     // m
    EXPECT_EQ(row.fallbacks, 0U) << name;
    EXPECT_GT(row.us_p99, 0.0) << name;
  }
}

TEST(ConstraintBudget, SeesWhatASmallBudgetCosts) {
  std::set<std::string> searching;
  for (const BudgetRow& row : measured().rows) {
    if (row.iterations != 1 || row.fallbacks == 0) continue;
    searching.insert(row.constraint);
    EXPECT_LE(row.used, 1) << row.constraint;
    if (row.constraint != "linear, line") {  // whose steps shrink so fast that one is nearly all
      EXPECT_GT(row.force_error.max, 0.1) << row.constraint;
    }
  }
  for (const char* name :
       {"streamline", "tick marks", "isosurface, formula", "isosurface, tets", "polyline", "linear, line"}) {
    EXPECT_TRUE(searching.contains(name)) << name;
  }
}

TEST(ConstraintBudget, SweepsOnlyWhatSearches) {
  for (const char* name : {"sphere", "circle", "isotropic drag", "grid axis"}) {
    EXPECT_EQ(std::count_if(measured().rows.begin(), measured().rows.end(),
                            [&](const BudgetRow& row) { return row.constraint == name; }),
              1)
        << name;
  }
}

// The references themselves: a probe on the feature is its own ideal proxy, and the guide is on it.
TEST(ConstraintBudget, RestsOnReferencesThatAreOnTheFeature) {
  for (const BudgetSubject& subject : budget_subjects()) {
    if (!subject.off_feature) continue;
    const IdealProxy ideal = subject.make_ideal();
    for (int n = 0; n < 50; ++n) {
      const Vec3 on = subject.guide(0.01 * n), ideal_of_off = ideal(on + Vec3{0.001, -0.002, 0.001});
      EXPECT_LT(subject.off_feature(ideal_of_off), 1e-9) << subject.name;
      if (subject.name != "polyline") {
        EXPECT_LT(subject.off_feature(on), 1e-9) << subject.name;
      }
    }
  }
}

TEST(ConstraintBudget, TellsTheReport) {
  const ReportSection section = constraint_budget_section(measured());
  EXPECT_EQ(section.table.size(), measured().rows.size());
  for (const auto& row : section.table) EXPECT_EQ(row.size(), section.columns.size());
  EXPECT_EQ(section.work_precision.size(), 3 * measured().rows.size());
  EXPECT_NE(section.plots.at(0).content.find("isosurface"), std::string::npos);
}

}  // namespace
}  // namespace palpate::test
