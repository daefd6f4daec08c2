/// Calibrations and the analysis of head tracking as parts of a report.
#pragma once

#include <string>
#include <vector>

#include "common/calibration/fit_report.h"
#include "common/calibration/head_error.h"
#include "lab/page/section.h"

namespace palpate {

/// Errors before and after, on measurements seen and left out; condition, chi-square, what cannot be told
/// apart and where to measure next; for a tracker with errors against the distance from the transmitter, and
/// beside the printed table 4.1 of the reference.
[[nodiscard]] ReportSection calibration_section(const FitReport& report);

/// A head before a screen. Metres, radians.
struct HeadErrorSetup {
  double eye_distance = 0.6;        ///< from the screen
  double separation = 0.063;        ///< of the eyes
  Vec2 position_error{0.01, 0.01};  ///< of the tracked head, along the screen and away from it
  double orientation_error = 2.0 * 0.017453292519943295;
  double screen_width = 1.2;
  double front = 0.2;   ///< how far objects stand out of the screen
  double behind = 0.3;  ///< and lie behind it
  double pixel = 0.0;   ///< size of one; 0: not known
};

/// What a point of the read-out suffers.
struct HeadErrorRow {
  Vec2 point{0.0};         ///< (x, z), the eyes at z > 0 [m]
  double position = 0.0;   ///< |F - E| by the position error [m]
  double bound = 0.0;      ///< on it, eq. 4.25 for this depth
  Vec2 orientation{0.0};   ///< |F_x - E_x|, |F_z - E_z| by the orientation error [m]
  double on_screen = 0.0;  ///< how far the larger of the drawn points moves by both errors together [m]
};

/// For depths from behind the screen to before it, on the bisector and at a quarter of the screen's width.
/// @throws Error (usage) for a setup that is none: eyes not before the screen, sizes not positive.
[[nodiscard]] std::vector<HeadErrorRow> head_error_rows(const HeadErrorSetup& setup);

/// The perceived grid over the true one, as figures 4.14 (a position error) and 4.15 (an orientation error)
/// show it.
[[nodiscard]] std::string head_error_picture(const HeadErrorSetup& setup);

[[nodiscard]] ReportSection head_error_section(const HeadErrorSetup& setup);

}  // namespace palpate
