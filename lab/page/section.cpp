#include "lab/page/section.h"

#include "lab/page/html.h"

namespace palpate {

std::string section_html(const ReportSection& section) {
  std::string out = "<h2>" + escaped(section.title) + "</h2>\n";
  for (const ReportPlot& plot : section.plots) {
    out += "<img src=\"" + escaped(plot.file) + "\" alt=\"" + escaped(plot.alt) + "\">\n";
  }
  for (const std::string& text : section.paragraphs) out += paragraph(text);
  if (section.table.empty()) return out;
  out += "<table><tr>";
  for (const std::string& heading : section.columns) out += "<th>" + escaped(heading) + "</th>";
  out += "</tr>\n";
  for (const auto& row : section.table) {
    out += "<tr>";
    for (const std::string& text : row) out += cell(text);
    out += "</tr>\n";
  }
  out += "</table>\n";
  if (section.csv.file.empty()) return out;
  const std::string file = escaped(section.csv.file);
  out += "<p><a href=\"" + file + "\">" + file + "</a>";
  if (!section.csv.dictionary.empty()) {
    const std::string words = escaped(section.csv.file.substr(0, section.csv.file.rfind('.')) + ".json");
    out += ", its columns: <a href=\"" + words + "\">" + words + "</a>";
  }
  return out + "</p>\n";
}

}  // namespace palpate
