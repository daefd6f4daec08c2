/// The report: what was measured, and the folder it is written to.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lab/data/stability.h"
#include "lab/data/sweep.h"
#include "lab/hand/constraint/constraint_sweep.h"
#include "lab/page/machine.h"
#include "lab/page/section.h"

namespace palpate {

/// A part without rows is neither on the page nor in the folder: each program's report has what concerns it.
struct Report {
  std::string title;  ///< "flow: carotid.vtk"
  std::string command_line;
  Machine machine;
  std::vector<std::string> scene;  ///< sentences: what was opened, field, grid, notes
  Sweep sweep;
  ConstraintSweep constraint;
  std::vector<ReportSection> sections;  ///< further ones, in the order of the page
  std::vector<StabilityCase> stability;
  double seconds = 0.0;  ///< that making the report took
};

/// Refuses a folder that exists, unless `replace` is set and it is empty or holds a report and nothing else.
/// @throws Error (usage), (work failed) where it cannot be made.
void check_report_folder(const std::filesystem::path& folder, bool replace);

/// Writes index.html, report.json, CSV tables and plots into a folder of another name, which then takes the
/// name.
/// @throws Error as check_report_folder().
void write_report(const Report& report, const std::filesystem::path& folder, bool replace);

/// @name The files of the folder
/// @{
[[nodiscard]] std::string report_json(const Report& report);
[[nodiscard]] std::string report_page(const Report& report);
[[nodiscard]] std::string work_precision_csv(const Report& report);
/// Every line of every row: what the rows are made from.
[[nodiscard]] std::string work_precision_lines_csv(const Report& report);
[[nodiscard]] std::string constraint_csv(const Report& report);
[[nodiscard]] std::string stability_csv(const Report& report);
/// Errors over run time and other numbers of the sections, with all digits: what their plots show.
[[nodiscard]] std::string sections_csv(const Report& report);
/// Error against run time, and the stated against the true error.
[[nodiscard]] std::string work_precision_plot(const Report& report);
[[nodiscard]] std::string honesty_plot(const Report& report);
/// Force error of the constraint's update, and distance of its proxy from the line, against its time.
[[nodiscard]] std::string constraint_force_plot(const Report& report);
[[nodiscard]] std::string constraint_distance_plot(const Report& report);
/// Whether the folder holds that file.
[[nodiscard]] bool in_folder(const Report& report, std::string_view file);
/// The part of the page that is about integrators of streamlines; empty without rows.
[[nodiscard]] std::string sweep_section(const Sweep& sweep);
/// The part of the page that is about the constraint; empty without rows.
[[nodiscard]] std::string constraint_section(const ConstraintSweep& sweep);
/// @}

}  // namespace palpate
