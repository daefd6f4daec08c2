// What `cardiac report` measures, on the built-in ventricle.
#include <cmath>

#include <gtest/gtest.h>

#include "lab/data/heart_errors.h"
#include "lab/hand/constraint/fibre_feel.h"
#include "lab/page/report.h"

namespace palpate {
namespace {

const std::vector<HeartErrorRow>& meshes() {
  static const std::vector<HeartErrorRow> rows = run_heart_errors(Effort::kQuick, 0, nullptr);
  return rows;
}
const FibreLineErrors& ventricle_lines() {
  static const FibreLineErrors lines = run_ventricle_lines(Effort::kQuick, 0, nullptr);
  return lines;
}

TEST(HeartErrors, FallAtSecondOrderWithTheCells) {
  const HeartErrorRow &coarse = meshes()[meshes().size() - 2], &fine = meshes().back();
  ASSERT_EQ(fine.cells.wall, 2 * coarse.cells.wall);
  EXPECT_NEAR(std::log2(coarse.volume / fine.volume), 2.0, 0.1);
  EXPECT_GT(std::log2(coarse.potential / fine.potential), 1.8);
  EXPECT_GT(std::log2(coarse.fibre / fine.fibre), 1.9);
  EXPECT_GT(std::log2(coarse.helix / fine.helix), 1.9);
  EXPECT_GT(coarse.fibre, 0.1);  // degrees: errors are of the mesh, not of rounding
}

TEST(FibreLineErrors, AreWhatTheLinesState) {
  const FibreLineErrors& lines = ventricle_lines();
  EXPECT_GT(lines.lines, 15U);
  EXPECT_GT(lines.mesh, 1e-6);
  EXPECT_LT(lines.mesh, 1e-3);
  EXPECT_LT(lines.rows.back().median, lines.rows.front().median);
  for (const FibreLineRow& row : lines.rows) {
    EXPECT_LT(row.median, 3.0 * row.stated) << row.step;
    EXPECT_GT(row.median, 0.03 * row.stated) << row.step;
  }
}

TEST(FibreFeel, FrictionGrowsAsFibresLeaveTheirLayer) {
  const std::vector<FrictionRow> rows = run_friction(Effort::kQuick, nullptr);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_NEAR(rows[0].expected, 0.5, 1e-12);                        // tau_min
  EXPECT_NEAR(rows[1].expected, 0.5 + 5.5 * std::sqrt(0.5), 1e-9);  // u = sin 45 degrees
  for (const FrictionRow& row : rows) EXPECT_NEAR(row.lag, row.expected, 0.05) << row.degrees;
}

TEST(HeartReport, HoldsWhatItPromisesAndHasWhatConcernsHearts) {
  const auto heart = layered(ventricle_mesh({}, {.wall = 4, .along = 20, .around = 48}));
  const FibreFeel feel = run_fibre_feel(heart, Effort::kQuick, nullptr);
  EXPECT_GT(feel.held, feel.steps / 10);  // most of the box is no wall
  const std::vector<FrictionRow> friction = run_friction(Effort::kQuick, nullptr);
  Report report;
  report.title = "cardiac: example ventricle";
  report.machine = this_machine();
  report.sections = {heart_errors_section(meshes()), fibre_lines_section({ventricle_lines()}),
                     fibre_feel_section("ventricle", feel, friction)};
  report.stability = heart_error_cases(meshes(), ventricle_lines());
  for (const StabilityCase& c : fibre_feel_cases(feel, friction)) report.stability.push_back(c);
  for (const StabilityCase& c : report.stability)
    EXPECT_TRUE(c.row.holds) << c.row.name << " " << c.row.measured;
  const std::string page = report_page(report), json = report_json(report);
  for (const char* file : {"heart_errors.svg", "fibre_lines.svg", "stability.csv"})
    EXPECT_NE(page.find(file), std::string::npos) << file;
  for (const char* quantity : {"part of the exact volume", "angle [degrees], root mean square",
                               "end point / diagonal, median", "proxy stays behind [mm]"})
    EXPECT_NE(json.find(quantity), std::string::npos) << quantity;
}

}  // namespace
}  // namespace palpate
