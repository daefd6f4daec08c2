/// A part of the report that brings its own text, plots, table and numbers.
#pragma once

#include <string>
#include <vector>

#include "common/base/work_precision.h"

namespace palpate {

struct ReportPlot {
  std::string file;  ///< "chain_work.svg", one of the names that report_files.cpp knows
  std::string alt;   ///< what is to be seen, for those who do not see it
  std::string svg;
};

struct ReportSection {
  std::string title;
  std::vector<std::string> paragraphs;
  std::vector<ReportPlot> plots;
  std::vector<std::string> columns;             ///< headings; the first column holds text
  std::vector<std::vector<std::string>> table;  ///< rows of as many cells
  std::vector<WorkPrecision> work_precision;    ///< for report.json
};

/// As it stands on the page.
[[nodiscard]] std::string section_html(const ReportSection& section);

}  // namespace palpate
