/// The parts of the panel about time: which step is shown, playing, and what is plotted at the probe.
#pragma once

#include <vector>

#include "common/window/panels/panel.h"

namespace palpate {

/// Nothing for a single state.
void draw_time(PanelState& state, const std::vector<double>& times);

/// Which scalar is plotted over time at the probe.
void choose_plotted(PanelState& state, const SceneInfo& info);

}  // namespace palpate
