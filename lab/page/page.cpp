#include <string>
#include <vector>

#include "common/base/text.h"
#include "lab/page/html.h"
#include "lab/page/report.h"

namespace palpate {
namespace {

constexpr const char* kStyle =
    "body{font:16px/1.5 sans-serif;max-width:60em;margin:2em auto;padding:0 1em;color:#222;background:#fff}"
    "table{border-collapse:collapse;margin:1em 0}td,th{padding:.25em .8em;border-bottom:1px solid "
    "#ddd;text-align:right}"
    "th{border-bottom:2px solid #888}td:first-child,th:first-child,td.text,th.text{text-align:left}"
    "img{max-width:100%;height:auto}.fails{background:#fde0dc}.small{color:#555;font-size:14px}code{"
    "background:#f3f3f3}";

std::string machine_text(const Machine& m) {
  return m.processor + ", " + counted(static_cast<std::uint64_t>(m.cores), "core") + ", " +
         bytes_text(m.memory_bytes) + " of memory; " + m.system + "; Palpate " + m.version + " built with " +
         m.build;
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

}  // namespace

std::string report_page(const Report& report) {
  std::string out = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" +
                    escaped(report.title) + "</title><style>" + kStyle + "</style></head><body>\n<h1>" +
                    escaped(report.title) + "</h1>\n";
  for (const std::string& sentence : report.scene) out += paragraph(sentence);
  out += paragraph("Measured on " + machine_text(report.machine) + ".");

  out += sweep_section(report.sweep);
  out += constraint_section(report.constraint);
  for (const ReportSection& section : report.sections) out += section_html(section);
  if (!report.stability.empty()) out += "<h2>Stability</h2>\n" + stability_table(report.stability);
  out += "<h2>Files</h2>\n<p>";
  std::string separator;
  for (const char* name :
       {"report.json", "work_precision.csv", "constraint.csv", "sections.csv", "stability.csv"}) {
    if (!in_folder(report, name)) continue;
    out += separator + "<a href=\"" + name + "\">" + name + "</a>";
    separator = ", ";
  }
  out += "</p>\n";
  out += "<p class=\"small\">Made by <code>" + escaped(report.command_line) + "</code> in " +
         escaped(three_digits(report.seconds)) + " s.</p>\n</body></html>\n";
  return out;
}

}  // namespace palpate
