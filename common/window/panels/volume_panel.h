/// The parts of the panel about volumes: transfer functions, rays, cuts, region and lenses.
#pragma once

#include <optional>

#include "common/window/panels/panel.h"

namespace palpate {

/// A volume that is all there is.
void draw_volume(PanelState& state, const SceneState& scene, VolumeView& volume, PanelActions& actions);

/// Which scalar of a flow is a volume around its lines, and how. @param volume none where none is shown yet.
void draw_flow_volume(PanelState& state, const SceneState& scene, std::optional<VolumeView>& volume,
                      PanelActions& actions);

/// Of tensors, as a volume with them.
void draw_anisotropy(PanelState& state, const SceneState& scene, VolumeView& volume, PanelActions& actions);

}  // namespace palpate
