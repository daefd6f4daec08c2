#include <cmath>

#include "common/base/text.h"
#include "common/report/html.h"
#include "common/report/plot.h"
#include "common/report/report.h"

namespace palpate {
namespace {

constexpr const char* kStyle =
    "body{font:16px/1.5 sans-serif;max-width:60em;margin:2em auto;padding:0 1em;color:#222;background:#fff}"
    "table{border-collapse:collapse;margin:1em 0}td,th{padding:.25em .8em;border-bottom:1px solid "
    "#ddd;text-align:right}"
    "th{border-bottom:2px solid #888}td:first-child,th:first-child,td.text,th.text{text-align:left}"
    "img{max-width:100%;height:auto}.fails{background:#fde0dc}.small{color:#555;font-size:14px}code{"
    "background:#f3f3f3}";

std::string percent(double fraction) {
  return std::isfinite(fraction) ? std::to_string(std::lround(100.0 * fraction)) + " %" : "none";
}

std::string machine_text(const Machine& m) {
  return m.processor + ", " + counted(static_cast<std::uint64_t>(m.cores), "core") + ", " +
         bytes_text(m.memory_bytes) + " of memory; " + m.system + "; Palpate " + m.version + " built with " +
         m.build;
}

std::string sweep_table(const Sweep& sweep) {
  std::string out =
      "<table><tr><th>method</th><th class=\"text\">setting</th><th>error, 95 % of lines</th><th>median</th>"
      "<th>worst</th><th>stated, 95 %</th><th>within stated</th><th>seconds</th><th>lines/s</th><th>ended "
      "otherwise</th></tr>\n";
  for (const SweepRow& row : sweep.rows) {
    out += "<tr>" + cell(row.method) + cell(row.parameter, true) + cell(three_digits(row.error.p95)) +
           cell(three_digits(row.error.median)) + cell(three_digits(row.error.max)) +
           cell(three_digits(row.error.stated)) + cell(percent(row.error.covered)) +
           cell(three_digits(row.seconds)) +
           cell(three_digits(static_cast<double>(row.lines) / row.seconds)) +
           cell(std::to_string(row.error.different_ends)) + "</tr>\n";
  }
  return out + "</table>\n";
}

std::string stability_table(const std::vector<StabilityCase>& cases) {
  std::string out =
      "<table><tr><th>case</th><th class=\"text\">what is measured</th><th>measured</th><th>limit</th>"
      "<th class=\"text\">unit</th><th class=\"text\">holds</th></tr>\n";
  for (const StabilityCase& c : cases) {
    out += std::string(c.row.holds ? "<tr>" : "<tr class=\"fails\">") + cell(c.row.name) +
           cell(c.meaning, true) + cell(three_digits(c.row.measured)) + cell(three_digits(c.row.limit)) +
           cell(c.unit, true) + cell(c.row.holds ? "yes" : "NO", true) + "</tr>\n";
  }
  return out + "</table>\n";
}

template <typename Value>
std::vector<PlotSeries> series_by_method(const Sweep& sweep, const Value& value) {
  std::vector<PlotSeries> all;
  for (const SweepRow& row : sweep.rows) {
    if (all.empty() || all.back().name != row.method) all.push_back({row.method, {}});
    all.back().points.push_back(value(row));
  }
  return all;
}

}  // namespace

std::string work_precision_plot(const Report& report) {
  return svg({.title = "Error against run time",
              .x_label = "run time of " + counted(report.sweep.reference_lines.size(), "line") + " [s], " +
                         counted(static_cast<std::uint64_t>(report.sweep.threads), "thread"),
              .y_label = "error of 95 % of the lines / diagonal",
              .series = series_by_method(report.sweep,
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
              .series = series_by_method(report.sweep,
                                         [](const SweepRow& r) {
                                           return PlotPoint{r.error.stated, r.error.p95};
                                         }),
              .floor = report.sweep.agreement.p95,
              .floor_label = "agreement of " + report.sweep.reference + " and " + report.sweep.second,
              .diagonal = true});
}

std::string report_page(const Report& report) {
  const Sweep& sweep = report.sweep;
  const LineComparison& agreement = sweep.agreement;
  std::string out = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" +
                    escaped(report.title) + "</title><style>" + kStyle + "</style></head><body>\n<h1>" +
                    escaped(report.title) + "</h1>\n";
  for (const std::string& sentence : report.scene) out += paragraph(sentence);
  out += paragraph("Measured on " + machine_text(report.machine) + ".");

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
                   "; errors below that, the dashed line, mean nothing.");
  out += sweep_table(sweep);
  out +=
      "<h2>Is the stated error honest?</h2>\n<img src=\"stated_error.svg\" alt=\"stated against true error, "
      "log-log\">\n";
  out += paragraph(
      "Every line carries its own estimate of its error. Below the dotted line it states more than it has; "
      "the column 'within stated' counts the lines that do.");
  out += constraint_section(report.constraint);
  for (const ReportSection& section : report.sections) out += section_html(section);
  out += "<h2>Stability</h2>\n" + stability_table(report.stability);
  out +=
      "<h2>Files</h2>\n<p><a href=\"report.json\">report.json</a>, <a "
      "href=\"work_precision.csv\">work_precision.csv</a>, "
      "<a href=\"constraint.csv\">constraint.csv</a>, <a href=\"stability.csv\">stability.csv</a></p>\n";
  out += "<p class=\"small\">Made by <code>" + escaped(report.command_line) + "</code> in " +
         escaped(three_digits(report.seconds)) + " s.</p>\n</body></html>\n";
  return out;
}

}  // namespace palpate
