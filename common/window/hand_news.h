/// What has happened to hand and device, each said once.
#pragma once

#include <cstdint>
#include <string>

#include "common/window/panels/panel.h"

namespace palpate {

class HandNews {
 public:
  /// Once a frame: says in `state` what is new. A stall of the machine is said beside what was said before, which
  /// may be an answer that was not read yet.
  /// @param through_surfaces what is popped through is a surface of a scalar field, else one line is left for the next
  void follow(const ProbeReadout& hand, bool through_surfaces, PanelState& state);

 private:
  std::string fault_, device_;
  int popped_ = 0;
  std::uint64_t stalls_ = 0;
};

}  // namespace palpate
