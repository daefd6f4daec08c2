/// Lines of equal value on a layer as a file: isochrones of a time of activation, isogonals of an angle.
#pragma once

#include <vector>

#include "apps/cardiac/heart_scene.h"
#include "common/base/progress.h"
#include "common/load/write/write_lines.h"

namespace palpate {

/// Lines with the value that each has: one column of all points. `seed` of a line is the index of its value,
/// `error` of a point how far it is off at most along its edge, as the value found there tells [data units].
struct LayerContours {
  double depth = 0.0;  ///< of the layer
  std::vector<Line> lines;
  PointColumn values{.name = "value", .values = {}};
  double lowest = 0.0, highest = 0.0;  ///< of what the layer has
};

/// Whether `--contours` or `--contour-spacing` asks for them. @throws Error (usage) where both do, or a word
/// is no number.
[[nodiscard]] bool wants_contours(const HeartOptions& options);

/// Of the layer that `--layer` names, half way through the wall without it.
/// @throws Error (usage) for a layer that is not there and for more than a thousand values; (work failed)
/// where no line has any of the values, naming those that there are; Cancelled.
[[nodiscard]] LayerContours make_layer_contours(const LayeredHeart& heart, const AngleProbe& probe,
                                                const Document& options, Progress* progress);

}  // namespace palpate
