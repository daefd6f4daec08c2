/// What is studied of devices and workbenches, without an input of fields.
#pragma once

#include "lab/study.h"

namespace palpate {

/// Fits a model to measurements; writes a section of a workbench file, pictures, a report, as asked for.
/// @throws Error.
[[nodiscard]] ReportAnswer study_calibration(const Study& study);
/// Writes a table of made measurements. @throws Error.
[[nodiscard]] ReportAnswer study_made_table(const Study& study);
/// A report of made calibrations of every kind, and of head tracking. @throws Error.
[[nodiscard]] ReportAnswer study_made_calibrations(const Study& study);
/// What errors of head tracking do before a screen; a report where a folder is named. @throws Error.
[[nodiscard]] ReportAnswer study_head_errors(const Study& study);
/// A report of how stiff walls may be. @throws Error.
[[nodiscard]] ReportAnswer study_walls(const Study& study);

}  // namespace palpate
