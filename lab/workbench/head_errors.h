/// What errors of head tracking do before a screen (calibration/head_error.h), as numbers and as a part of a report.
#pragma once

#include <string>
#include <vector>

#include "common/math/vec.h"
#include "common/scene/document/device_options.h"
#include "lab/page/section.h"

namespace palpate {

/// A head before a screen. Metres, radians.
struct HeadErrorSetup {
  double eye_distance = 0.0;  ///< from the screen
  double separation = 0.0;    ///< of the eyes
  Vec2 position_error{0.0};   ///< of the tracked head, along the screen and away from it
  double orientation_error = 0.0;
  double screen_width = 0.0;
  double front = 0.0;   ///< how far objects stand out of the screen
  double behind = 0.0;  ///< and lie behind it
  double pixel = 0.0;   ///< size of one; 0: not known
};

/// @throws Error (usage) where the position error is no pair of numbers.
[[nodiscard]] HeadErrorSetup head_error_setup(const HeadErrorOptions& options);

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
