/// The part of the panel about lenses of a volume: a list of them, each with its size and what it does.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/render/volume/volume_view.h"
#include "common/window/panels/volume/transfer_panel.h"

namespace palpate {

/// @param looks of new lenses, by Lens::field (SceneState::looks); empty: plain ones. @param bounds of the
/// scene.
/// @param context name of the field around lenses. @param histograms for transfer functions of single lenses.
/// @return the lens that the mouse is to move from now on, a new one among them.
std::optional<std::size_t> draw_lens_panel(VolumeView& view, const std::vector<Late<Lens>>& appearances,
                                           const std::string& context, const Box& bounds,
                                           CachedHistogram& histograms);

}  // namespace palpate
