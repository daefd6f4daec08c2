/// Pictures of a volume with slices beside it, without a display.
#pragma once

#include <vector>

#include "common/render/render_image.h"
#include "common/render/scene_view.h"
#include "common/render/slice/slice_panes.h"

namespace palpate {

/// What a pane shows.
struct PaneImage {
  Pane pane;
  Image image;  ///< of its size
};
/// A picture put together of its panes.
[[nodiscard]] Image join_panes(const std::vector<PaneImage>& parts, const Background& background, int width,
                               int height);

/// As render_image(), where the volume of `view` asks for panes of all of them: the figures are those of the volume's
/// own pane.
/// @throws Error as that; (usage) for panes for two eyes.
[[nodiscard]] RenderedImage render_panes(const SceneView& view, int width, int height, int repeat = 0,
                                         double budget = 0.0, bool error = false);

}  // namespace palpate
