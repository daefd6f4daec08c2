/// Panes that show all of some data, through its middle.
#pragma once

#include "common/render/slice/slice_panes.h"

namespace palpate::test {

[[nodiscard]] inline SlicePanes panes_about(const Box& bounds) {
  SlicePanes panes;
  panes.cross = panes.center = bounds.center();
  return panes;
}

}  // namespace palpate::test
