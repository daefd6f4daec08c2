#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/base/text.h"
#include "lab/page/html.h"
#include "lab/page/plot.h"
#include "lab/page/report.h"

namespace palpate {
namespace {

std::string percent(double fraction) {
  return std::isfinite(fraction) ? std::to_string(std::lround(100.0 * fraction)) + " %" : "none";
}

std::string sweep_table(const Sweep& sweep) {
  std::string out =
      "<table><tr><th>method</th><th class=\"text\">setting</th><th>error, 95 % of lines</th><th>median</th>"
      "<th>worst</th><th>stated, 95 %</th><th>within stated</th><th>seconds</th><th>lines/s</th><th>lines "
      "judged</th><th>ended elsewhere</th><th>not finished</th><th>missing</th></tr>\n";
  for (const SweepRow& row : sweep.rows) {
    out += "<tr>" + cell(row.method) + cell(row.parameter, true) + cell(three_digits(row.error.p95)) +
           cell(three_digits(row.error.median)) + cell(three_digits(row.error.max)) +
           cell(three_digits(row.error.stated)) + cell(percent(row.error.covered)) +
           cell(three_digits(row.seconds)) +
           cell(three_digits(static_cast<double>(row.lines) / row.seconds)) +
           cell(std::to_string(row.error.judged)) + cell(std::to_string(row.error.elsewhere)) +
           cell(std::to_string(row.error.unfinished)) + cell(std::to_string(row.error.missing)) + "</tr>\n";
  }
  return out + "</table>\n";
}

template <typename Value>
std::vector<PlotSeries> series_by_method(const std::vector<SweepRow>& rows, const Value& value) {
  std::vector<PlotSeries> all;
  for (const SweepRow& row : rows) {
    if (all.empty() || all.back().name != row.method) all.push_back({row.method, {}});
    all.back().points.push_back(value(row));
  }
  return all;
}

/// The rows of methods that state an error.
std::vector<SweepRow> stating(std::vector<SweepRow> rows) {
  std::erase_if(rows, [](const SweepRow& row) { return std::isnan(row.error.covered); });
  return rows;
}

}  // namespace

std::string work_precision_plot(const Report& report) {
  return svg({.title = "Error against run time",
              .x_label = "run time of " + counted(report.sweep.reference_lines.size(), "line") + " [s], " +
                         counted(static_cast<std::uint64_t>(report.sweep.threads), "thread"),
              .y_label = "error of 95 % of the lines / diagonal",
              .series = series_by_method(report.sweep.rows,
                                         [](const SweepRow& r) {
                                           return PlotPoint{r.seconds, r.error.p95};
                                         }),
              .floor = report.sweep.agreement.p95,
              .floor_label = "agreement of " + report.sweep.reference + " and " + report.sweep.second});
}

std::string honesty_plot(const Report& report) {
  return svg({.title = "Stated against true error",
              .x_label = "error that the lines state / diagonal (95 % of the lines)",
              .y_label = "error that they have / diagonal (95 % of the lines)",
              .series = series_by_method(stating(report.sweep.rows),
                                         [](const SweepRow& r) {
                                           return PlotPoint{r.error.stated, r.error.p95};
                                         }),
              .floor = report.sweep.agreement.p95,
              .floor_label = "agreement of " + report.sweep.reference + " and " + report.sweep.second,
              .diagonal = true});
}

std::string sweep_section(const Sweep& sweep) {
  if (sweep.rows.empty()) return "";
  const LineComparison& agreement = sweep.agreement;
  std::string out;
  out +=
      "<h2>Error against run time</h2>\n<img src=\"work_precision.svg\" alt=\"error against run time, "
      "log-log\">\n";
  out += paragraph(
      counted(sweep.reference_lines.size(), "line") + " of " + counted(sweep.seeds, "seed") + ", up to " +
      short_number(sweep.max_length) +
      " data units long. The error of a line is its largest distance from the reference line at equal arc "
      "length, taken every " +
      short_number(sweep.spacing) +
      " data units and at the end, divided by the diagonal of the domain. Left out of errors and times: " +
      counted(sweep.lines_inside, "line") + " that end inside (sinks and closed orbits) and " +
      counted(sweep.seeds_outside, "seed") + " outside the data.");
  out += paragraph("Reference: " + sweep.reference + ". The independent method " + sweep.second +
                   " agrees with it to " + three_digits(agreement.median) + " (median), " +
                   three_digits(agreement.p95) + " (95 % of lines), " + three_digits(agreement.max) +
                   " (worst) over " + counted(agreement.compared, "line") +
                   "; errors below that, the dashed line, mean nothing. " +
                   (sweep.disputed > 0 ? "They disagree on " + counted(sweep.disputed, "line") +
                                             ", by more than " + short_number(kDisputed) +
                                             " or in how it ends: what is said of these is not certain. "
                                       : std::string()) +
                   "Rows of " + sweep.reference.substr(0, sweep.reference.find(' ')) + " are judged by " +
                   sweep.second + ".");
  out += paragraph(
      "Every method is judged on every line. A line that ends for another reason, elsewhere, that does not finish "
      "within " +
      std::to_string(kMostSweptSteps) +
      " pieces, or that is missing has failed: its error is infinite, and a setting has a point in the plots only where "
      "95 % of its lines have one. work_precision_lines.csv has every line of every row.");
  if (std::ranges::any_of(sweep.rows, [](const SweepRow& row) { return row.method.starts_with("VTK"); })) {
    out += paragraph(
        "Rows of VTK are its vtkStreamTracer, given the same mesh, values and seeds: Runge-Kutta 4 and 4-5 by their step, which is "
        "kept. Between its points lines are cubic, which counts as its error. It stops somewhere before the border, so its lines are "
        "not compared at their ends; one that stops farther away than two comparisons are apart has failed. It states no error. Its "
        "time is that of the processor; on tetrahedra each run builds its search tree, which is most of the time of few lines.");
  }
  if (!sweep.peer_missing.empty()) out += paragraph(sweep.peer_missing);
  out += sweep_table(sweep);
  out +=
      "<h2>Is the stated error honest?</h2>\n<img src=\"stated_error.svg\" alt=\"stated against true error, "
      "log-log\">\n";
  out += paragraph(
      "Every line carries its own estimate of its error. Below the dotted line it states more than it has; "
      "the column 'within stated' counts the lines that do.");
  return out;
}

}  // namespace palpate
