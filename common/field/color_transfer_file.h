/// Transfer functions as text: a table of comma-separated numbers that diffs well.
///
///   # comments and blank lines are passed over
///   value,red,green,blue,opacity
///   0,0,0,0,0
///   1200,1,0.9,0.8,0.5
///
/// One point a row, by ascending value; colours are sRGB and all but the value lie in [0, 1]. With `fraction`
/// in place of `value`, 0 and 1 stand for the lowest and highest value of the data.
#pragma once

#include <optional>
#include <string>

#include "common/field/color_transfer.h"

namespace palpate {

/// Reads `file` for data whose values go from `lower` to `upper`.
/// @throws Error (bad input) naming the line that is no point; NaN and infinity are none.
[[nodiscard]] ColorTransfer read_color_transfer(const std::string& file, double lower, double upper);

/// The text of a file that gives the same function back, bit by bit.
[[nodiscard]] std::string color_transfer_text(const ColorTransfer& transfer);

/// The function on one line, as options and sessions have it: "points:V,R,G,B,A/V,R,G,B,A/…", the same
/// numbers with '/' between points. @pre it has a point.
[[nodiscard]] std::string transfer_words(const ColorTransfer& transfer);
/// What transfer_words() wrote; absent where `text` does not begin with "points:".
/// @throws Error (usage) for points that are none.
[[nodiscard]] std::optional<ColorTransfer> transfer_from_words(const std::string& text);

}  // namespace palpate
