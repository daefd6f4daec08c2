/// What a scene that has just been read or changed makes of the view.
#pragma once

#include "common/compose/window_model.h"
#include "common/render/scene_view.h"

namespace palpate {

/// Puts `scene` into `view`. Where the scene is the same input with other settings (`new_input` false), what
/// the user has chosen about the look of its volume, tensors and tracts stays; a new input brings its own
/// look. The camera is left as it is.
void show_scene(const SceneState& scene, bool new_input, SceneView& view);

}  // namespace palpate
