/// Calibrations of measurements, from a table or made ones, and what a report says of them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/calibration/fit_report.h"
#include "common/scene/document/device_options.h"
#include "lab/page/section.h"
#include "lab/workbench/distortion_pictures.h"

namespace palpate {

/// A calibration and the section of a workbench file that it gives.
struct Calibrated {
  FitReport report;
  std::string section;                      ///< its name: "tracker"
  std::string text;                         ///< the section; empty for a spline, which is for comparison
  std::vector<DistortionPicture> pictures;  ///< of a tracker
};

/// The name of the section that a calibration of `kind` gives.
[[nodiscard]] std::string section_of(const std::string& kind);

/// @param seed of made measurements. @param pictured a tracker's pictures are wanted.
/// @throws Error (bad input) for a table that is none or says too little; (usage).
[[nodiscard]] Calibrated calibrated(const CalibrationOptions& options, std::uint64_t seed, bool pictured);

/// A table of made measurements of `options.kind`, as CSV.
[[nodiscard]] std::string made_table(const CalibrationOptions& options, std::uint64_t seed);

/// Errors before and after, on measurements seen and left out; condition, chi-square, what cannot be told
/// apart and where to measure next; for a tracker with errors against the distance from the transmitter, and
/// beside the printed table 4.1 of the reference.
[[nodiscard]] ReportSection calibration_section(const FitReport& report);

}  // namespace palpate
