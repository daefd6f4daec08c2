/// The haptic modes of dtmri.
#pragma once

#include <vector>

#include "common/hand/mode/haptic_mode.h"

namespace palpate {

/// The default one first.
[[nodiscard]] std::vector<HapticMode> dtmri_modes();

}  // namespace palpate
