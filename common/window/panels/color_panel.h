/// The part of the panel about what colours lines, or a layer.
#pragma once

#include "common/window/panels/panel.h"

namespace palpate {

/// A program's part of the panel: of lines, by a quantity of theirs or an array of the data.
void draw_line_colors(PanelContext& on);
/// The same of a heart's layer, by an angle or an array.
void draw_layer_colors(PanelContext& on);

}  // namespace palpate
