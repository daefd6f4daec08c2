/// The numbers that colour lines, and where they lie in the colour map.
#pragma once

#include <vector>

#include "common/render/line_style.h"

namespace palpate {

/// One number a point of what `style` colours by, line after line, in data units; the seed's index for
/// kSeed, the number of the end reason for kTermination, zeros for kDirection and kUniform.
/// @throws Error (work failed) where the style's array has another number of values than there are points.
[[nodiscard]] std::vector<double> line_values(const std::vector<Line>& lines, const LineStyle& style);

/// Where each value lies in the map: 0 at the range's lower end, 1 at its upper one, clamped; NaN stays
/// NaN. A range without extent gives 1/2.
[[nodiscard]] std::vector<float> map_coordinates(const std::vector<double>& values, const LineStyle& style,
                                                 const ValueRange& range);

}  // namespace palpate
