/// A part of the report that brings its own text, plots, table and numbers.
#pragma once

#include <string>
#include <vector>

#include "common/base/work_precision.h"

namespace palpate {

struct ReportPlot {
  std::string file;     ///< "chain_work.svg", one of the names that report_files.cpp knows
  std::string alt;      ///< what is to be seen, for those who do not see it
  std::string content;  ///< of the file: SVG, or the bytes of a PNG
};

/// The table with all digits, as a file of its own.
struct ReportCsv {
  std::string file;  ///< as ReportPlot::file; empty: there is none
  std::string content;
  std::string dictionary;  ///< JSON: what its columns hold, beside it under its name and .json; empty: none
};

/// A number that is neither error nor time, for report.json.
struct Measurement {
  std::string subject;    ///< "virtual wall, delay"
  std::string method;     ///< "firm hand"
  std::string parameter;  ///< "2 ms"
  std::string quantity;   ///< with its unit: "largest stable stiffness [N/m]"
  double value = 0.0;
};

struct ReportSection {
  std::string title;
  std::vector<std::string> paragraphs;
  std::vector<ReportPlot> plots;
  std::vector<std::string> columns;             ///< headings; the first column holds text
  std::vector<std::vector<std::string>> table;  ///< rows of as many cells
  ReportCsv csv;
  std::vector<WorkPrecision> work_precision;  ///< for report.json
  std::vector<Measurement> measurements;      ///< likewise
};

/// As it stands on the page.
[[nodiscard]] std::string section_html(const ReportSection& section);

}  // namespace palpate
