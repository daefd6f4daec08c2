/// The parts of the panel about volumes: transfer functions, rays, cuts, region and lenses.
#pragma once

#include "common/app/window/panel.h"

namespace palpate {

void draw_volume(PanelState& state, const SceneState& scene, VolumeView& volume, PanelActions& actions);

/// Of tensors, as a volume with them.
void draw_anisotropy(PanelState& state, const SceneState& scene, VolumeView& volume, PanelActions& actions);

}  // namespace palpate
