/// What a scene that has just been read or changed makes of the view.
#pragma once

#include <cstdint>

#include "common/compose/window_model.h"
#include "common/render/scene_view.h"

namespace palpate {

/// Whether a scene is of an input that has just been opened, of the same one with a changed document, or of a
/// document that was taken back or restored.
enum class ShownAs : std::uint8_t { kNew, kChanged, kRestored };

/// Puts `scene` into `view`. Where the document changed, what mouse and panels have done since to volume,
/// tensors and tracts stays, which is newer than the scene; else all is as the scene has it. A new input brings
/// its own style of lines. The camera is left as it is.
void show_scene(const SceneState& scene, ShownAs as, SceneView& view);

}  // namespace palpate
