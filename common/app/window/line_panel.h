/// The parts of the panel about lines: how they are traced, or on which layer of a heart, and their colours.
#pragma once

#include "common/app/window/panel.h"

namespace palpate {

void draw_lines(PanelState& state, const SceneState& scene);

/// Of a heart: which layer is shown, and where its fibres start.
void draw_layer(PanelState& state, const SceneState& scene);

/// What colours the lines, or the layer.
void draw_color(PanelState& state, const SceneState& scene, SceneView& view);

}  // namespace palpate
