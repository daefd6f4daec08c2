/// The part of the panel about where lines start.
#pragma once

#include "common/window/panels/panel.h"

namespace palpate {

/// Edits state.seeds, which go into the settings. @param speed whether the field has one.
void draw_seeds(PanelState& state, bool speed);

}  // namespace palpate
