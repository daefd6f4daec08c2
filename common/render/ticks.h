/// Round numbers along a scale, and how they are written.
#pragma once

#include <string>
#include <vector>

#include "common/render/scene_view.h"

namespace palpate {

struct Tick {
  double value = 0.0;
  std::string text;
};

/// Multiples of 1, 2 or 5 times a power of ten within the range, at most `max_count` (>= 2) of them; for
/// a logarithmic scale whole decades, every second or further apart if need be, and if the range has
/// fewer than two of them the steps 1, 2, 5 within a decade. The range's middle alone where it has no extent.
[[nodiscard]] std::vector<Tick> ticks(const ValueRange& range, bool logarithmic, int max_count);

}  // namespace palpate
