/// The haptic modes of flow.
#pragma once

#include <vector>

#include "common/hand/mode/haptic_mode.h"

namespace palpate {

/// The default one first.
[[nodiscard]] std::vector<HapticMode> flow_modes();

}  // namespace palpate
