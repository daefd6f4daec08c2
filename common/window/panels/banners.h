/// Banners over the picture: the error of what was asked for last, and warnings about what is shown.
#pragma once

#include "common/window/panels/panel.h"

namespace palpate {

/// Draws them at the foot of the picture: all their words, until they are closed, which changes `state`. A button
/// has the closed ones back; they stay in the panel, too.
void draw_banners(PanelState& state, const WindowLayout& layout);

}  // namespace palpate
