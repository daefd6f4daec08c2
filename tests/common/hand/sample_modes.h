/// Two ways of feeling a flow, for tests: held by a streamline, and dragged.
#pragma once

#include <vector>

#include "common/hand/mode/haptic_mode.h"

namespace palpate::test {

inline std::vector<HapticMode> sample_modes() {
  std::vector<HapticMode> modes = modes_of(FieldKind::kVector);
  modes.resize(2);
  return modes;
}

}  // namespace palpate::test
