/// The parts of the panel about a volume.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/window/panels/panel.h"

namespace palpate {

/// A program's part of the panel: of a volume that is all that is looked at.
void draw_volume(PanelContext& on);

/// Colours, rays, cuts and lenses of a volume.
/// @param field name of what is seen around lenses. @param fields that there are. @param beside edited: those
/// for lenses. @param felt value at the probe.
void draw_volume_appearance(PanelState& state, const SceneState& scene, const std::string& field,
                            const std::vector<std::string>& fields, std::vector<std::string>& secondary,
                            std::optional<double> isovalue, VolumeView& volume, PanelActions& actions);

/// How rays are cast.
void draw_rays(VolumeView& volume);

/// All scalars of the scene where the probe is.
void draw_values_at_probe(const PanelState& state, const std::string& field, const VolumeView& volume);

/// What lenses show that have nothing of their own; that of new ones where there are none.
[[nodiscard]] EditedTransfer focus_of(const VolumeView& volume, const SceneState& scene);
/// Has them show `focus`.
void set_focus(VolumeView& volume, const EditedTransfer& focus);

}  // namespace palpate
