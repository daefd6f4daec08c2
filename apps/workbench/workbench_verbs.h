/// What workbench does.
#pragma once

#include <string>
#include <vector>

#include "apps/workbench/command_line.h"
#include "apps/workbench/distortion_pictures.h"
#include "common/base/progress.h"
#include "common/calibration/fit_report.h"
#include "common/cli/console.h"
#include "lab/data/stability.h"
#include "lab/page/section.h"

namespace palpate {

struct WorkbenchContext {
  Console& console;
  Progress& progress;
  std::string command_line;  ///< as typed
};

/// @name Verbs. @throws Error.
/// @{
void run_calibrate(const WorkbenchOptions& options, const WorkbenchContext& context);
void run_controls(const WorkbenchOptions& options, const WorkbenchContext& context);
void run_example(const WorkbenchOptions& options, const WorkbenchContext& context);
void run_workbench_report(const WorkbenchOptions& options, const WorkbenchContext& context);
void run_screen(const WorkbenchOptions& options, const WorkbenchContext& context);
void run_stability_verb(const WorkbenchOptions& options, const WorkbenchContext& context);
void run_devices(const WorkbenchOptions& options, const WorkbenchContext& context);
void run_doctor(const WorkbenchOptions& options, const WorkbenchContext& context);
void run_feel(const WorkbenchOptions& options, const WorkbenchContext& context);
void run_tune(const WorkbenchOptions& options, const WorkbenchContext& context);
void run_monitor(const WorkbenchOptions& options, const WorkbenchContext& context);
/// @}

/// A calibration and the section of workbench.toml that it gives.
struct Calibrated {
  FitReport report;
  std::string section;                      ///< its name: "tracker"
  std::string text;                         ///< the section
  std::vector<DistortionPicture> pictures;  ///< of a tracker
};
[[nodiscard]] Calibrated calibrated(const WorkbenchOptions& options);

/// What a report says of it: of a tracker with its pictures, `drawn` or, where that is empty, drawn here.
[[nodiscard]] std::vector<ReportSection> sections_of(const Calibrated& done, const WorkbenchContext& context,
                                                     std::vector<ReportPlot> drawn = {});

/// Writes index.html, report.json and pictures.
void write_sections(const WorkbenchOptions& options, const WorkbenchContext& context,
                    const std::filesystem::path& folder, const std::string& title,
                    std::vector<ReportSection> sections, std::vector<StabilityCase> cases, double seconds);

}  // namespace palpate
