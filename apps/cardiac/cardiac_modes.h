/// The haptic modes of cardiac.
#pragma once

#include <vector>

#include "common/hand/mode/haptic_mode.h"

namespace palpate {

/// The default one first. Their scenes have the depth as scalar and the fibres as tensor.
[[nodiscard]] std::vector<HapticMode> cardiac_modes();

}  // namespace palpate
