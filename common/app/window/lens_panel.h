/// The part of the panel about lenses of a volume: a list of them, each with its size and what it does.
#pragma once

#include <cstddef>
#include <optional>

#include "common/render/volume/volume_view.h"

namespace palpate {

/// @param model of new lenses (SceneState::lens). @param bounds of the scene.
/// @return the lens that the mouse is to move from now on, a new one among them.
std::optional<std::size_t> draw_lens_panel(VolumeView& view, const Lens& model, const Box& bounds);

}  // namespace palpate
