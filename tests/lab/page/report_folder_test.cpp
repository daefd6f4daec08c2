#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "lab/page/report.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

Report sample_report() {
  Report report;
  report.title = "flow: a<b>.vtk";
  report.machine = this_machine();
  report.sweep.subject = "a, \"velocity\"";
  report.sweep.rows.push_back(
      {.method = "dp54", .parameter = "tolerance=1e-06", .error = {.p95 = 1e-7}, .seconds = 0.5});
  report.sweep.rows.back().error.max = HUGE_VAL;
  report.constraint.subject = "a";
  report.constraint.release_force = 2.0;
  report.constraint.rows.push_back({.path = PathKind::kTremor,
                                    .budget = {.iterations = 4, .cells = 8},
                                    .force_error = {.max = 0.25},
                                    .us_p99 = 3.0});
  StabilityCase hole;
  hole.row = {"NaN hole", 1.0, 0.0, false};
  hole.unit = "points";
  hole.meaning = "what was done";
  report.stability.push_back(hole);
  return report;
}

ExitCode code_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.code();
  }
  return ExitCode::kDone;
}

TEST(ReportFolder, HoldsPageTablesAndPlots) {
  const TempFolder folder;
  write_report(sample_report(), folder.path("r"), false);
  for (const char* name :
       {"index.html", "report.json", "work_precision.csv", "work_precision.svg", "stability.csv",
        "stated_error.svg", "constraint.csv", "constraint_force.svg", "constraint_distance.svg"}) {
    EXPECT_GT(std::filesystem::file_size(folder.path("r") / name), 0U) << name;
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1)
      << "no temporary name stays";
}

TEST(ReportFolder, KeepsTheSchemaOfReportJson) {
  const std::string json = report_json(sample_report());
  for (const char* key : {"\"machine\"", "\"work_precision\"", "\"subject\"", "\"method\"", "\"parameter\"",
                          "\"error\"", "\"error_kind\"", "\"seconds\"", "\"stability\"", "\"case\"",
                          "\"measured\"", "\"limit\"", "\"holds\""}) {
    EXPECT_NE(json.find(key), std::string::npos) << key;
  }
  EXPECT_NE(json.find("\"error\": null"), std::string::npos) << "JSON has no infinity";
}

TEST(ReportFolder, TellsOfTheConstraintBesideTheIntegrators) {
  const std::string json = report_json(sample_report());
  EXPECT_NE(json.find("streamline constraint, tremor"), std::string::npos);
  EXPECT_NE(json.find("\"iterations=4\""), std::string::npos);
  EXPECT_NE(json.find("3e-06"), std::string::npos) << "seconds, not microseconds";
  EXPECT_NE(constraint_csv(sample_report()).find("tremor,4,8,iterations,"), std::string::npos);
  EXPECT_NE(report_page(sample_report()).find("constraint_force.svg"), std::string::npos);
  // A report of a scene without lines to follow has no such part.
  Report without = sample_report();
  without.constraint.rows.clear();
  EXPECT_EQ(report_page(without).find("constraint_force.svg"), std::string::npos);
}

TEST(ReportFolder, HoldsSectionsWithTheirPlotsAndNumbers) {
  Report report = sample_report();
  report.sections.push_back({.title = "Chains & loops",
                             .paragraphs = {"what was done"},
                             .plots = {{"chain_work.svg", "a plot", "<svg/>"}},
                             .columns = {"case", "work"},
                             .table = {{"line < plane", "12"}},
                             .work_precision = {{"loops", "sum", "plane", 0.5, "energy", 1e-6}},
                             .measurements = {{"loops", "sum", "line", "work [J]", 1.0 / 3.0}}});
  const TempFolder folder;
  write_report(report, folder.path("r"), false);
  EXPECT_GT(std::filesystem::file_size(folder.path("r") / "chain_work.svg"), 0U);
  EXPECT_NO_THROW(write_report(report, folder.path("r"), true)) << "it knows its own files again";
  const std::string page = report_page(report);
  for (const char* text : {"<h2>Chains &amp; loops</h2>", "<img src=\"chain_work.svg\" alt=\"a plot\">",
                           "<p>what was done</p>", "<th>work</th>", "<td>line &lt; plane</td><td>12</td>"}) {
    EXPECT_NE(page.find(text), std::string::npos) << text;
  }
  EXPECT_NE(report_json(report).find("\"subject\": \"loops\""), std::string::npos);
  EXPECT_GT(std::filesystem::file_size(folder.path("r") / "sections.csv"), 0U);
  EXPECT_NE(page.find("href=\"sections.csv\""), std::string::npos);
  EXPECT_EQ(sections_csv(report),
            "section,subject,method,parameter,quantity,value,seconds\n"
            "\"Chains & loops\",\"loops\",\"sum\",\"plane\",\"energy\",0.5,1e-06\n"
            "\"Chains & loops\",\"loops\",\"sum\",\"line\",\"work [J]\",0.3333333333333333,\n");
}

TEST(ReportFolder, ShowsFailuresAndEscapesNames) {
  const std::string page = report_page(sample_report());
  EXPECT_NE(page.find("class=\"fails\""), std::string::npos);
  EXPECT_EQ(page.find("a<b>"), std::string::npos);
  EXPECT_NE(page.find(this_machine().processor), std::string::npos);
}

TEST(ReportFolder, IsReplacedOnlyWhenAskedAndOnlyIfItIsAReport) {
  const TempFolder folder;
  const auto target = folder.path("r");
  write_report(sample_report(), target, false);
  EXPECT_EQ(code_of([&] { check_report_folder(target, false); }), ExitCode::kUsage);
  write_report(sample_report(), target.string() + "/", true);

  folder.write("r/thesis.tex", "years of work");
  EXPECT_EQ(code_of([&] { write_report(sample_report(), target, true); }), ExitCode::kUsage);
  EXPECT_TRUE(std::filesystem::exists(target / "thesis.tex"));
  EXPECT_EQ(code_of([&] { check_report_folder(folder.write("file", ""), true); }), ExitCode::kUsage);
  EXPECT_EQ(code_of([&] { check_report_folder(folder.path("no/such/place"), false); }),
            ExitCode::kWorkFailed);
}

}  // namespace
}  // namespace palpate::test
