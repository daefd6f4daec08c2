/// The parts of the panel about lines: how they are traced, or on which layer of a heart, and their colours.
#pragma once

#include "common/render/camera.h"
#include "common/window/panels/panel.h"

namespace palpate {

void draw_lines(PanelState& state, const SceneState& scene);

/// Of a heart: which layer is shown, where its fibres start, and where it is cut away.
/// @param camera a new cut faces it.
void draw_layer(PanelState& state, const SceneState& scene, const Camera& camera);

/// What colours the lines, or the layer.
void draw_color(PanelState& state, const SceneState& scene, SceneView& view);

}  // namespace palpate
