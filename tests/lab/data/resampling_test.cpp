// The report on scalars that are taken on another grid: errors as theory has them, table, plot and CSV.
#include "lab/data/resampling.h"

#include <cmath>

#include <gtest/gtest.h>

#include "lab/page/report.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

const Box kBox{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}};

// The half of the box with x < 0 has no data.
ResampledScalar square() {
  return {"square, \"x\"", [](const Vec3& x, CellHint&) {
            if (!(x.x >= 0.0) || !kBox.contains(x)) return ScalarSample{};
            return ScalarSample{x.x * x.x, SampleStatus::kOk};
          }};
}

// |s_h - s| <= h^2 / 4, root mean square h^2 / sqrt(30), of a range of 1 (scalar_lattice_test.cpp).
TEST(Resampling, TellsErrorAndTimeAgainstTheNumberOfPoints) {
  const std::vector<ResamplingRow> rows = run_resampling({square()}, kBox, Effort::kQuick, 2, nullptr);
  ASSERT_EQ(rows.size(), 3U);
  int points = 16;
  for (const ResamplingRow& row : rows) {
    EXPECT_EQ(row.points, Index3(points));
    const double h = 2.0 / (points - 1);
    EXPECT_NEAR(row.error.rms, h * h / std::sqrt(30.0), 0.03 * h * h);
    EXPECT_NEAR(row.error.worst, h * h / 4.0, 0.002 * h * h);
    EXPECT_NEAR(row.error.outside, 0.5, 0.02);
    EXPECT_NEAR(row.error.hidden, 0.5 * h, 0.015) << "half a cell at the border";
    EXPECT_GT(row.seconds, 0.0);
    points *= 2;
  }

  const ReportSection section = resampling_section("box", rows);
  ASSERT_EQ(section.table.size(), 3U);
  EXPECT_EQ(section.table[1][1], "32 x 32 x 32");
  EXPECT_EQ(section.table[0].size(), section.columns.size());
  ASSERT_EQ(section.work_precision.size(), 3U);
  EXPECT_EQ(section.work_precision[2].error, rows[2].error.rms);
  EXPECT_NE(section.plots.front().content.find("square"), std::string::npos);
  EXPECT_NE(section.csv.content.find("\n\"square, \"\"x\"\"\",32,32,32,"), std::string::npos)
      << section.csv.content;

  // In the folder, named on the page; a second report may take its place.
  const TempFolder folder;
  Report report{.title = "flow: box", .machine = this_machine()};
  report.sections.push_back(section);
  write_report(report, folder.path("r"), false);
  write_report(report, folder.path("r"), true);
  EXPECT_GT(std::filesystem::file_size(folder.path("r/resampling.csv")), 200U);
  EXPECT_NE(report_page(report).find("href=\"resampling.csv\""), std::string::npos);
}

}  // namespace
}  // namespace palpate::test
