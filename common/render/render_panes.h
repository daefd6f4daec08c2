/// Pictures of a volume with slices beside it, without a display.
#pragma once

#include "common/render/render_image.h"
#include "common/render/scene_view.h"

namespace palpate {

/// As render_image(), where the volume of `view` asks for panes of all of them: the figures are those of the volume's
/// own pane.
/// @throws Error as that; (usage) for panes for two eyes.
[[nodiscard]] RenderedImage render_panes(const SceneView& view, int width, int height, int repeat = 0,
                                         double budget = 0.0, bool error = false);

}  // namespace palpate
