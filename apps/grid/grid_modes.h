/// The haptic modes of grid.
#pragma once

#include <vector>

#include "common/hand/mode/haptic_mode.h"

namespace palpate {

/// The default one first.
[[nodiscard]] std::vector<HapticMode> grid_modes();

}  // namespace palpate
