/// What has happened to hand and device, each said once.
#pragma once

#include <cstdint>
#include <string>

#include "common/window/panels/panel.h"

namespace palpate {

class HandNews {
 public:
  /// Once a frame: says in `state` what is new.
  void follow(const ProbeSession& touch, PanelState& state);

 private:
  std::string fault_, device_;
  int popped_ = 0;
  std::uint64_t stalls_ = 0;
};

}  // namespace palpate
